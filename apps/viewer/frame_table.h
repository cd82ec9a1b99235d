#pragma once
/// \file
/// What the last frames did: what the plots show, and write as a table.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "percale/diagnostic.h"
#include "percale/world.h"

namespace percale::viewer {

struct FrameRow {
  StepReport report;
  std::optional<double> stretch99;  ///< 99th percentile of the springs' stretch, where it was measured.
};

class FrameTable {
 public:
  /// So many frames are kept.
  static constexpr std::size_t kFrames = 1200;

  /// A frame that has just been simulated. What came after it before a reset is forgotten.
  void Add(const StepReport& report);
  /// Enters the percentile for a frame, if that is kept.
  void SetStretch99(int frame, double stretch99);

  /// Oldest first.
  std::span<const FrameRow> rows() const;
  /// Of gravity, in the first frame since the start: what the plots count from [J].
  double potentialAtStart() const { return potentialAtStart_; }

 private:
  std::vector<FrameRow> rows_;  // up to twice as many as are kept, so that the old ones go all at once
  double potentialAtStart_ = 0;
};

/// Writes the rows to NAME-plots-N.csv in the current folder, NAME being the scene file's and N the first
/// number that is free. Returns the file.
Result<std::filesystem::path> ExportFrames(std::span<const FrameRow> rows, const std::filesystem::path& sceneFile);

}  // namespace percale::viewer
