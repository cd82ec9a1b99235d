#pragma once
/// \file
/// What the tests of drawing share: folders that go away, and cloths of known shape.

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "mesh/cloth_model.h"
#include "render/picture.h"

namespace percale::test {

/// An empty folder of its own for a test, removed at its end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    static std::atomic<int> counter{0};
    const auto seed = std::filesystem::file_time_type::clock::now().time_since_epoch().count();
    path_ = std::filesystem::temp_directory_path() /
            ("percale-test-" + std::to_string(seed) + "-" + std::to_string(counter++));
    std::filesystem::create_directory(path_);
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  int EntryCount() const {
    int count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path_)) ++count;
    return count;
  }

 private:
  std::filesystem::path path_;
};

inline void WriteText(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

/// A cloth of the classic grid, its positions given by a function of uv.
struct TestCloth {
  ClothModel model;
  std::vector<Edge> springs;

  TestCloth(const ClothSettings& settings, const std::function<Vec3(Vec2)>& shape)
      : model(MakeGrid(settings)), springs(EnabledSprings(model, settings)) {
    for (std::size_t i = 0; i < model.start.size(); ++i) model.start[i] = shape(model.uv[i]);
  }
  ClothShape Shape() const { return {model.start, model.uv, model.triangles, springs}; }
};

inline ClothSettings Grid(int points) {
  ClothSettings settings;
  settings.numWidthPoints = settings.numHeightPoints = points;
  return settings;
}

/// The unit square in x, y at z = 0, its front (the side of the normals) towards the course's camera.
inline Vec3 Upright(Vec2 uv) {
  return {uv.x, 1 - uv.y, 0};
}

/// Fails the test with the messages where there is no value.
template <class T>
T Must(Result<T> result) {
  INFO(Format(result.diagnostics()));
  REQUIRE(result.ok());
  return std::move(*result);
}

/// Compares a picture with the one in `file`; with PERCALE_UPDATE_REFERENCE in the environment, writes that first.
inline void CheckReference(const Image& image, const std::filesystem::path& file) {
  if (std::getenv("PERCALE_UPDATE_REFERENCE")) Must(WritePng(file, image, {.level = 9, .text = {}}));
  const Image expected = Must(ReadPng(file));
  REQUIRE(expected.width == image.width);
  REQUIRE(expected.height == image.height);
  // Drivers differ by rounding everywhere, and by much at a few edges.
  double sum = 0;
  int far = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    int greatest = 0;
    for (std::size_t k = 0; k < 3; ++k)
      greatest = std::max(greatest, std::abs(int(image.rgba[i + k]) - int(expected.rgba[i + k])));
    sum += greatest;
    far += greatest > 24;
  }
  const double pixels = double(image.width) * image.height;
  CHECK(sum / pixels < 1.5);
  CHECK(far / pixels < 0.01);
}

inline bool Contains(const Diagnostics& diagnostics, const std::string& text) {
  return Format(diagnostics).find(text) != std::string::npos;
}

}  // namespace percale::test
