#pragma once
/// \file
/// The view that the window shows: camera, shader with its values, textures, overlays. It follows its files: what is
/// saved while the viewer runs shows at once.

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "apps/viewer/file_watch.h"
#include "apps/viewer/kept_uniforms.h"
#include "apps/viewer/messages.h"
#include "apps/viewer/session_log.h"
#include "apps/viewer/undo.h"
#include "apps/viewer/viewer.h"
#include "render/gl_device.h"
#include "render/scene_view.h"

namespace percale::viewer {

class LiveView {
 public:
  /// With the view of the options. All but the options must outlive it. Changes of values and textures go to `undo`.
  LiveView(const ViewerOptions& options, GlDevice& device, SessionLog& log, Messages& messages, UndoStack& undo);

  const View& view() const { return view_; }
  /// Shows what a picture shows, but for the look, which is its scene's.
  void Show(View view);

  void Orbit(double dx, double dy, int width, int height);
  void Pan(double dx, double dy, int width, int height);
  void Dolly(double steps);
  void ResetCamera(const Scene& scene);
  bool cameraMoved() const { return cameraMoved_; }  ///< By the user.

  /// Draws as a scene's look says.
  void SetLook(const LookSettings& look);
  /// Draws the springs over any shader, or no longer.
  void ToggleWireframe();
  void SetHeatMap(const HeatMapSettings& settings);
  void SetOverlays(const Overlays& overlays);
  /// Of the shaders, number 0..3. Can be undone.
  void SetTexture(std::size_t number, const std::filesystem::path& file);

  const std::vector<std::string>& shaderNames() const { return shaders_.names(); }
  /// The shader that follows the current one, or with `by` < 0 the one before; empty where there is none.
  std::string NextShader(int by) const;
  /// Makes a shader from the template.
  Status CreateShader(const std::string& name);

  std::span<const ShaderParameter> ShaderParameters();  ///< Of the current shader.
  UniformValue Uniform(const ShaderParameter& parameter) const;
  void SetUniform(const ShaderParameter& parameter, const UniformValue& value);
  void RefuseUniform(const ShaderParameter& parameter, const std::string& why);
  /// The current shader's parameters as the shader has them; forgets what was kept.
  void ResetUniforms();
  bool HasOwnUniforms() const { return !view_.uniforms.empty(); }

  /// Takes a change of values or of a texture back, or makes it again. Returns false where it is of something else.
  bool Travel(const Change& change, bool forth);

  /// Writes what is to be kept, and logs the camera; call it once per picture. `now` counts seconds.
  void Update(double now);
  /// Reads again what has changed; returns whether anything has.
  bool LookAtFiles();
  /// Reads everything again.
  void Reload();
  /// Writes all that is to be kept, at the end.
  void Finish() { kept_.WriteAll(); }
  /// What is wrong with the current shader, and with those that something was wrong with before.
  void TellProblems();
  /// Problems of drawing the last picture, none if all went well.
  void TellDrawing(const Status& drawn, const Diagnostics& warnings);

 private:
  std::optional<UniformValue> Chosen(const std::string& uniform) const;
  void Choose(const std::string& shader, const ShaderValues& values);
  void AdoptUniforms();
  bool UsesTexture(std::size_t number);
  void LogTexture(std::size_t number);
  void ReloadTextures(const std::vector<std::filesystem::path>& files);
  bool LookAtTextures();

  GlDevice& device_;
  ShaderLibrary& shaders_;
  SessionLog& log_;
  Messages& messages_;
  UndoStack& undo_;
  View view_;
  bool cameraMoved_, cameraUnlogged_ = false;
  std::map<std::filesystem::path, FileWatch> textureWatches_;
  KeptUniforms kept_;
  std::string givenShader_;      // The one that was begun with, or that a picture showed...
  UniformValues givenUniforms_;  // ...with these values, which come before those that are kept...
  bool givenAreWhole_;           // ...or stand alone.
  std::set<std::string> reportedShaders_;
};

}  // namespace percale::viewer
