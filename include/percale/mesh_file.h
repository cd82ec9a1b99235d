#pragma once
/// \file
/// Meshes from files, and writers for meshes and for caches of many frames. Every file that is written appears whole or
/// not at all: it is written beside its place and renamed when finished.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "percale/diagnostic.h"
#include "percale/rest_mesh.h"
#include "percale/vertex_cache.h"
#include "percale/world.h"

namespace percale {

/// Reads a mesh by the extension of `file`:
///   .obj  Wavefront: v, vt, f; g and o become groups of vertices
///   .ply  Stanford, as text or binary: x y z, and s t, u v or texture_u texture_v; texcoord of faces
/// Polygons become triangles. Vertices keep their order; those of no triangle are left out, as are duplicates of
/// triangles, and triangles are turned to face like their neighbours; warnings tell of it. Errors name the line and
/// column, or the byte of a binary file. Texture coordinates that differ between the corners at a vertex all count for
/// the rest shape, and for drawing the first.
Result<RestMesh> LoadMesh(const std::filesystem::path& file, const MeshOptions& options = {});

/// Reads how the vertices of a mesh move from a file of any program: one point for each vertex of the mesh's file.
///   .pc2  PointCache2: the time between two samples in seconds or frames
///   .mdd  Motion Designer: a time per sample [s]; these must be even
/// Its positions are in the unit of the mesh's file, which has `scale` metres. `file` of the result is left empty.
Result<VertexCache> LoadVertexCache(const std::filesystem::path& file, const RestMesh& mesh, double scale);

/// Takes the frames of one run and writes them by the extension of `file`:
///   .csv  one table: frame,cloth,vertex,x,y,z with 17 significant digits
///   .obj  .ply  one mesh per frame, numbered name_0001.obj when there is more than one frame
///   .pc2  PointCache2: all frames in one file, and the mesh beside it as FILE.obj
/// Several cloths become one mesh, cloth after cloth.
class CacheWriter {
 public:
  /// Opens a writer, or says why not: unknown extension, folder missing or not writable.
  /// `frameSeconds` is the time between two written frames [s], which .pc2 records.
  static Result<CacheWriter> Open(const std::filesystem::path& file, double frameSeconds);

  ~CacheWriter();  ///< Without Finish: removes what was begun.
  CacheWriter(CacheWriter&&) noexcept;
  CacheWriter& operator=(CacheWriter&&) noexcept;

  /// Appends the state of `world` as frame number `frame`.
  Status Add(const World& world, int frame);
  /// Puts the files in their places; returns their names.
  Result<std::vector<std::filesystem::path>> Finish();

 private:
  struct Impl;
  explicit CacheWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Gives back, frame by frame, the triangles and positions that a file holds:
///   .pc2        PointCache2; the mesh is FILE.obj beside it
///   .obj  .ply  one mesh; where there is no such file, those numbered name_0001.obj, which must be alike
/// A .csv has no triangles and cannot be read so.
class CacheReader {
 public:
  /// Vertices and triangles of one cloth.
  struct Cloth {
    int vertices = 0;
    std::vector<Triangle> triangles;
  };

  /// Opens a file of any program, or says why not.
  static Result<CacheReader> Open(const std::filesystem::path& file);

  ~CacheReader();
  CacheReader(CacheReader&&) noexcept;
  CacheReader& operator=(CacheReader&&) noexcept;

  /// The cloths that were written to an .obj; one that has all vertices where the file does not tell them apart.
  const std::vector<Cloth>& cloths() const;
  int frames() const;  ///< >= 1.
  /// Reads the positions of the next frame, cloth after cloth [m], and returns its number: in a .pc2 from 0, of a
  /// numbered file the one in its name. To be called once per frame.
  Result<int> Next(std::vector<Vec3>& positions);

 private:
  struct Impl;
  explicit CacheReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// What a cache or mesh file holds, for `percale info`.
struct CacheInfo {
  std::string format;  ///< "PointCache2", "Wavefront OBJ", ...
  int frames = 0;
  int vertices = 0;   ///< Per frame.
  int triangles = 0;  ///< 0 where the format has none.
  double frameSeconds = 0;
  Vec3 boxMin, boxMax;  ///< Over all frames [m].
};
Result<CacheInfo> ReadCacheInfo(const std::filesystem::path& file);

}  // namespace percale
