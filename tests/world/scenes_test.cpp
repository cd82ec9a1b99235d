// The scenes of the project, run.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "percale/scene_file.h"
#include "percale/world.h"
#include "tests/sanitized.h"

namespace percale {
namespace {

TEST_CASE("Every scene of the project stays whole for its first second") {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator("scene")) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  REQUIRE(files.size() >= 10);
  for (const auto& file : files) {
    CAPTURE(file.string());
    const Result<Scene> scene = LoadScene(file);
    REQUIRE(scene);
    World world(*scene);
    for (int frame = 0; frame < test::Frames(scene->simulation.framesPerSecond); ++frame) world.Step();
    CHECK_FALSE(world.report().divergence.has_value());
    // Provot's one sweep leaves some springs a little above 1.1 times their length. Around a lone pin, which carries
    // all the weight, the yarns of a fabric lock.
    CHECK(world.report().greatestStretch < (scene->simulation.engine == Engine::Springs ? 1.25 : 1.5));
    double greatest = 0;
    for (int c = 0; c < world.ClothCount(); ++c) {
      for (const Vec3& x : world.Cloth(c).positions()) {
        REQUIRE(IsFinite(x));
        greatest = std::max({greatest, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
      }
    }
    CHECK(greatest < 10);
  }
}

TEST_CASE("The curtain opens, and closes again" * doctest::skip(test::kSanitized)) {
  const Result<Scene> scene = LoadScene("scene/curtain.json");
  REQUIRE(scene);
  World world(*scene);
  // The gap is where the inner hems are apart: the left curtain's greatest x to the right one's least.
  const auto gap = [&] {
    double left = -10, right = 10;
    for (const std::int32_t pin : world.Cloth(0).pinned())
      left = std::max(left, world.Cloth(0).positions()[static_cast<std::size_t>(pin)].x);
    for (const std::int32_t pin : world.Cloth(1).pinned())
      right = std::min(right, world.Cloth(1).positions()[static_cast<std::size_t>(pin)].x);
    return right - left;
  };
  const double closed = gap();
  CHECK(closed < 0.05);
  const int fps = scene->simulation.framesPerSecond;
  for (int frame = 0; frame < 5 * fps; ++frame) world.Step();
  CHECK(gap() > 1);
  for (int frame = 0; frame < 6 * fps; ++frame) world.Step();
  CHECK(gap() == doctest::Approx(closed).epsilon(1e-9));
  CHECK_FALSE(world.report().divergence.has_value());
}

}  // namespace
}  // namespace percale
