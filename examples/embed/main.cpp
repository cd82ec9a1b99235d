// Percale in another program: lets a scene run for a second and prints how deep the cloth hangs.
#include <algorithm>
#include <cstdio>

#include "percale/scene_file.h"
#include "percale/world.h"

int main(int argc, char** argv) {
  auto scene = percale::LoadScene(argc > 1 ? argv[1] : "scene/pinned2.json");
  if (!scene) {
    std::fputs(percale::Format(scene.diagnostics()).c_str(), stderr);
    return 3;
  }
  percale::World world(*scene);
  for (int frame = 0; frame < 90; ++frame) world.Step();

  double lowest = 1e9;
  for (const percale::Vec3& x : world.Cloth(0).positions()) lowest = std::min(lowest, x.y);
  std::printf("lowest point after %.1f s: %.17g m\n", world.report().time, lowest);
}
