#pragma once
/// \file
/// What shot, render and the run without a display share: a painter and the view that the command
/// line asks for.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/cli/options.h"
#include "apps/cli/session.h"
#include "percale/world.h"
#include "render/picture.h"

namespace percale::cli {

/// The view of the scene, or of the picture that was opened, with the command line's choices.
percale::View MakeView(const Options& options, const Scene& scene, const std::optional<percale::View>& picture = {});

/// Enters the command line's --uniform into the view, if they fit the parameters of its shader. Returns
/// the exit code.
int ApplyUniforms(const Options& options, std::span<const ShaderParameter> parameters, percale::View& view);

/// Enters what the viewer has kept of the shader's parameters, unless a picture has brought its own. Returns
/// what is wrong with the file.
Diagnostics ApplyKeptUniforms(const Options& options, const Session& session, const std::filesystem::path& root,
                              std::span<const ShaderParameter> parameters, percale::View& view);

/// A painter and its view.
struct Studio {
  Painter painter;
  percale::View view;
  std::filesystem::path root;  ///< The project's folder.
};

/// Opens the studio, and checks the names of shader and uniforms. On failure prints what is wrong
/// and returns the exit code: 5 without graphics.
std::variant<Studio, int> OpenStudio(const Options& options, const Session& session);

/// Draws the World as it stands; prints warnings and errors. Nothing when it failed (kInvalid: the
/// shader is at fault).
std::optional<Image> Paint(Studio& studio, const World& world);

/// Writes a PNG file that tells what it shows, from the project's folder `root` (render/view_file.h), `more` behind
/// that.
Status SavePicture(const std::filesystem::path& file, const Image& image, const std::filesystem::path& root,
                   const Scene& scene, const percale::View& view, int frame, std::vector<PngText> more = {},
                   const WorldState* state = nullptr);

/// Paints the World and writes such a file. Returns the exit code.
int WritePicture(Studio& studio, const World& world, const Session& session, const std::filesystem::path& file);

/// NAME.EXTENSION for a scene file NAME.json, in the current folder.
std::filesystem::path DefaultOutput(const Session& session, const char* extension);

/// Fails early where a file could not be written, before minutes of simulation. Returns the exit code.
int CheckWritable(const std::filesystem::path& file);
/// The same of a file in the folder that is named by -o, which is made where it is missing.
int MakeWritable(const std::filesystem::path& folder, const std::string& name);

/// Runs the World as long as the options say, else `defaultFrames` frames, into a video: an mp4 file, or a folder
/// of numbered pictures (render/video.h). Prints where it is. Returns the exit code.
int Film(Studio& studio, World& world, const Options& options, const Session& session,
         const std::filesystem::path& file, int defaultFrames);

}  // namespace percale::cli
