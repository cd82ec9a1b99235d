#pragma once
/// \file
/// Scene files (JSON). The format is that of the course, with more keys.

#include <filesystem>
#include <map>
#include <string>

#include "percale/diagnostic.h"
#include "percale/scene.h"

namespace percale {

/// Where each value of a loaded scene comes from, by its path ("/cloth/0/ks"). A path that is not
/// in the map has its default.
using Origins = std::map<std::string, Place>;

/// Reads a scene file, and the meshes that it names. On failure every problem of the file, each with its place; never
/// throws for bad input. `origins`, if given, is filled with the place of each value that the file states.
Result<Scene> LoadScene(const std::filesystem::path& file, Origins* origins = nullptr);

/// The same for a text in memory; `name` stands for the file in messages.
Result<Scene> ParseScene(const std::string& text, const std::string& name, Origins* origins = nullptr);

/// The file of a mesh or cache that a cloth or collider names: a path that is not absolute begins at the folder of
/// `scene.name`.
std::filesystem::path MeshFile(const Scene& scene, const std::string& mesh);

/// Reads the meshes that the cloths of shape Shape::Mesh, and such colliders with their caches, name and do not hold
/// yet with these settings. Changed settings need it before CheckScene accepts them.
Status LoadMeshes(Scene& scene);

/// The scene with the paths of its meshes and caches absolute, for a text that is kept elsewhere.
Scene WithAbsolutePaths(Scene scene);

/// The scene for a text that goes to other machines: the paths of its meshes and caches begin at `project` where all of
/// them lie in that folder, else at the folder of `scene.name`. Those that lie in neither stay as they are.
Scene WithPortablePaths(Scene scene, const std::filesystem::path& project);

/// The scene as JSON text that `ParseScene` reads back to the same scene; states every parameter.
std::string FormatScene(const Scene& scene);

/// The JSON schema (draft 2020-12) of scene files, from the parameter table.
std::string SceneSchema();

}  // namespace percale
