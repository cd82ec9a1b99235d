#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "apps/cli/run.h"
#include "apps/cli/session.h"
#include "apps/cli/verbs.h"
#include "core/text.h"
#include "io/atomic_file.h"
#include "io/cache_kind.h"
#include "mesh/cloth_model.h"
#include "mesh/rest_mesh.h"
#include "percale/mesh_file.h"
#include "world/limits.h"

namespace percale::cli {
namespace {

namespace fs = std::filesystem;

/// What a point takes in a running World, its springs included: 550 bytes measured at 1000 x 1000.
constexpr double kBytesPerPoint = 560;

std::string Short(double number) {
  return std::isinf(number) ? "unlimited" : Text("%.4g", number);
}

void PrintFabricCloth(const ClothSettings& cloth, std::size_t index) {
  const ClothSize size = SizeOf(cloth);
  const RestMesh mesh = MakeClothMesh(cloth);
  std::printf("cloth %zu\n", index);
  if (cloth.shape == Shape::Grid) {
    std::printf("  shape            grid, %s x %s m, %d x %d points\n", Short(cloth.width).c_str(),
                Short(cloth.height).c_str(), cloth.numWidthPoints, cloth.numHeightPoints);
  } else if (cloth.shape == Shape::Disc) {
    std::printf("  shape            disc, radius %s m, %d rings\n", Short(cloth.radius).c_str(), cloth.rings);
  } else {
    std::printf("  shape            mesh %s\n", cloth.mesh.c_str());
    for (const VertexGroup& group : mesh.groups)
      std::printf("  group            %s, %zu vertices\n", group.name.c_str(), group.vertices.size());
  }
  std::printf("  points           %zu, %zu pinned\n", mesh.positions.size(), PinnedVertices(cloth).size());
  std::printf("  spacing          about %s m\n", Short(size.spacing).c_str());
  std::printf("  triangles        %zu\n", mesh.triangles.size());
  std::printf("  area             %s m^2 at rest\n", Short(size.area).c_str());
  std::printf("  mass             %s kg, %s kg/m^2\n", Short(size.area * cloth.density).c_str(),
              Short(cloth.density).c_str());
  std::printf("  stretch          %s N/m warp, %s N/m weft, shear %s N/m\n", Short(cloth.stretchWarp).c_str(),
              Short(cloth.stretchWeft).c_str(), Short(cloth.shear).c_str());
  std::printf("  bend             %s N m warp, %s N m weft\n", Short(cloth.bendWarp).c_str(),
              Short(cloth.bendWeft).c_str());
}

void PrintCloth(const ClothSettings& cloth, std::size_t index, double timeStep) {
  const auto w = std::int64_t(cloth.numWidthPoints), h = std::int64_t(cloth.numHeightPoints);
  const std::int64_t structural = (w - 1) * h + w * (h - 1), shearing = 2 * (w - 1) * (h - 1);
  const std::int64_t bending = std::max<std::int64_t>(w - 2, 0) * h + w * std::max<std::int64_t>(h - 2, 0);
  const std::int64_t enabled = (cloth.enableStructural ? structural : 0) + (cloth.enableShearing ? shearing : 0) +
                               (cloth.enableBending ? bending : 0);
  std::set<std::int64_t> pins;
  for (const GridPoint& p : cloth.pinned) pins.insert(p.j * w + p.i);

  std::printf("cloth %zu\n", index);
  std::printf("  size             %s x %s m, %s\n", Short(cloth.width).c_str(), Short(cloth.height).c_str(),
              cloth.orientation == Orientation::Horizontal ? "horizontal" : "vertical");
  std::printf("  points           %lld (%lld x %lld), %zu pinned\n", static_cast<long long>(w * h),
              static_cast<long long>(w), static_cast<long long>(h), pins.size());
  std::printf("  spacing          %s x %s m\n", Short(cloth.width / double(w - 1)).c_str(),
              Short(cloth.height / double(h - 1)).c_str());
  std::printf("  triangles        %lld\n", static_cast<long long>(2 * (w - 1) * (h - 1)));
  std::printf("  springs          %lld structural, %lld shearing, %lld bending; %lld enabled\n",
              static_cast<long long>(structural), static_cast<long long>(shearing), static_cast<long long>(bending),
              static_cast<long long>(enabled));
  std::printf("  mass             %s kg, %s kg per point\n", Short(PointMass(cloth) * double(w * h)).c_str(),
              Short(PointMass(cloth)).c_str());
  std::printf("  ks               %s N/m; stable below %s N/m\n", Short(cloth.ks).c_str(),
              Short(LargestStableKs(cloth, timeStep)).c_str());
  std::printf("  thickness        %s m; sensible up to %s m\n", Short(cloth.thickness).c_str(),
              Short(LargestSensibleThickness(cloth)).c_str());
  std::printf("  damping          %s %% per step\n", Short(cloth.damping).c_str());
}

/// Where a checkpoint or a picture stands.
void PrintState(const Options& options, const Session& session) {
  if (!session.state) {
    std::printf("shows              frame %d from the start\n", session.frame);
    return;
  }
  const WorldState& state = *session.state;
  const StepReport& report = state.report;
  std::printf("stands at          frame %d, %.4g s, step %lld\n", report.frame, report.time,
              static_cast<long long>(report.step));
  if (!state.handles.empty() || !state.balls.empty() || !state.gusts.empty()) {
    std::printf("in it              %zu handles, %zu balls, %zu gusts\n", state.handles.size(), state.balls.size(),
                state.gusts.size());
  }
  std::printf("greatest stretch   %.6f\n", report.greatestStretch);
  std::printf("kinetic energy     %.6g J\n", report.kineticEnergy);
  std::printf("state              %016llx\n", static_cast<unsigned long long>(MakeWorld(options, session).StateHash()));
}

void PrintScene(const Options& options, const Session& session) {
  const Scene& scene = session.scene;
  double points = 0;
  const bool fabric = scene.simulation.engine == Engine::Fabric;
  for (const ClothSettings& cloth : scene.cloths) points += double(VertexCount(cloth));
  const char* const kind = session.view ? "picture" : session.state ? "checkpoint" : "scene";
  std::printf("%s: %s\n", PathText(session.file).c_str(), kind);
  if (session.view || session.state) PrintState(options, session);
  std::printf("time step          1/%lld s (%d frames per second, %d steps each)\n",
              static_cast<long long>(scene.simulation.framesPerSecond) * scene.simulation.stepsPerFrame,
              scene.simulation.framesPerSecond, scene.simulation.stepsPerFrame);
  for (std::size_t i = 0; i < scene.cloths.size(); ++i) {
    if (fabric)
      PrintFabricCloth(scene.cloths[i], i);
    else
      PrintCloth(scene.cloths[i], i, scene.TimeStep());
  }
  if (!scene.patches.empty()) std::printf("patches            %zu\n", scene.patches.size());
  std::printf("colliders          %zu spheres, %zu planes, %zu of other shapes\n", scene.spheres.size(),
              scene.planes.size(), scene.colliders.size());
  std::printf("pin motions        %zu\n", scene.pinMotions.size());
  if (!scene.colliderMotions.empty()) std::printf("collider motions   %zu\n", scene.colliderMotions.size());
  std::printf(
      "wind               %s\n",
      (fabric ? scene.wind.airDensity > 0 && scene.wind.velocity != Vec3{} : scene.wind.drag > 0) ? "yes" : "no");
  std::printf("points in all      %.0f\n", points);
  std::printf("memory             about %s\n", Megabytes(points * kBytesPerPoint).c_str());
}

int PrintCache(const fs::path& file) {
  const auto info = ReadCacheInfo(file);
  PrintDiagnostics(info.diagnostics());
  if (!info) return kInvalid;
  std::error_code code;
  const auto size = fs::file_size(file, code);
  std::printf("%s: %s\n", PathText(file).c_str(), info->format.c_str());
  std::printf("frames             %d\n", info->frames);
  if (info->frameSeconds > 0) std::printf("time per frame     %.6g s\n", info->frameSeconds);
  std::printf("vertices           %d\n", info->vertices);
  if (info->triangles > 0) std::printf("triangles          %d\n", info->triangles);
  std::printf("box                (%.6g, %.6g, %.6g) .. (%.6g, %.6g, %.6g) m\n", info->boxMin.x, info->boxMin.y,
              info->boxMin.z, info->boxMax.x, info->boxMax.y, info->boxMax.z);
  std::printf("size               %s\n", Megabytes(code ? 0 : double(size)).c_str());
  return kDone;
}

}  // namespace

int Info(const Options& options) {
  std::vector<std::string> files = options.files;
  if (files.empty()) files.emplace_back();  // the default scene
  int worst = kDone;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (i > 0) std::printf("\n");
    int code = kDone;
    if (!files[i].empty() && CacheKindOf(TextPath(files[i]))) {
      code = PrintCache(TextPath(files[i]));
    } else {
      Options one = options;
      one.scene = files[i];
      const auto opened = OpenSession(one);
      if (const int* failure = std::get_if<int>(&opened))
        code = *failure;
      else
        PrintScene(one, std::get<Session>(opened));
    }
    if (code != kDone) worst = code;
  }
  return worst;
}

}  // namespace percale::cli
