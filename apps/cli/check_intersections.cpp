#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "apps/cli/platform.h"
#include "apps/cli/run.h"
#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "io/atomic_file.h"
#include "io/cache_kind.h"
#include "percale/intersections.h"
#include "percale/mesh_file.h"

namespace percale::cli {
namespace {

std::string Count(std::int64_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

/// What one file adds up to.
struct IntersectionVerdict {
  int frames = 0;
  std::int64_t intersections = 0;

  /// One line for a frame that has some.
  void Add(int frame, const ClothIntersections& found) {
    ++frames;
    intersections += found.count;
    if (found.count == 0) return;
    const ClothIntersection& first = found.first.front();
    std::string triangle = "triangle " + std::to_string(first.triangle);
    if (first.triangleCloth != first.edgeCloth) triangle += " of cloth " + std::to_string(first.triangleCloth);
    std::printf("frame %d: %s, first: edge %d-%d of cloth %d through %s at (%.6g, %.6g, %.6g)\n", frame,
                Count(found.count, "intersection").c_str(), int(first.edge.a), int(first.edge.b), first.edgeCloth,
                triangle.c_str(), first.place.x, first.place.y, first.place.z);
    std::fflush(stdout);
  }
  int Print(const std::string& file) const {
    std::printf("%s: %s, %s\n", file.c_str(), Count(frames, "frame").c_str(),
                Count(intersections, "intersection").c_str());
    return intersections == 0 ? kDone : kFailed;
  }
};

int JudgeCache(const std::filesystem::path& file, int threads) {
  auto reader = CacheReader::Open(file);
  PrintDiagnostics(reader.diagnostics());
  if (!reader) return kInvalid;
  std::vector<ClothTopology> cloths;
  for (const CacheReader::Cloth& cloth : reader->cloths()) cloths.push_back({cloth.vertices, cloth.triangles});
  ClothJudge judge(cloths, threads);
  std::vector<Vec3> positions;
  IntersectionVerdict verdict;
  while (verdict.frames < reader->frames()) {
    if (Interrupted()) {
      verdict.Print(PathText(file));
      std::fprintf(stderr, "percale: interrupted after %d of %s\n", verdict.frames,
                   Count(reader->frames(), "frame").c_str());
      return kInterrupted;
    }
    const auto frame = reader->Next(positions);
    PrintDiagnostics(frame.diagnostics());
    if (!frame) {
      if (verdict.frames > 0) verdict.Print(PathText(file));
      return kInvalid;
    }
    verdict.Add(*frame, judge.Count(positions, 1));
  }
  return verdict.Print(PathText(file));
}

int JudgeScene(const Options& options) {
  const auto opened = OpenSession(options);
  if (const int* failure = std::get_if<int>(&opened)) return *failure;
  const Session& session = std::get<Session>(opened);
  const World world = MakeWorld(options, session);
  IntersectionVerdict verdict;
  verdict.Add(world.report().frame, ClothJudge(world, options.threads).Count(world, 1));
  return verdict.Print(PathText(session.file));
}

}  // namespace

int CheckIntersections(const Options& options) {
  CatchInterrupts();
  std::vector<std::string> files = options.files;
  if (files.empty()) files.emplace_back();  // the default scene
  int worst = kDone;
  for (const std::string& name : files) {
    Options one = options;
    one.scene = name;
    const bool cache = !name.empty() && CacheKindOf(TextPath(name));
    const int code = cache ? JudgeCache(TextPath(name), options.threads) : JudgeScene(one);
    if (code == kInterrupted) return code;
    worst = std::max(worst, code);  // an input that cannot be judged outweighs one that intersects
  }
  return worst;
}

}  // namespace percale::cli
