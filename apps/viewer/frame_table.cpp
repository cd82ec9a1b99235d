#include "apps/viewer/frame_table.h"

#include <algorithm>
#include <string>
#include <utility>

#include "io/atomic_file.h"
#include "io/report_table.h"

namespace percale::viewer {

void FrameTable::Add(const StepReport& report) {
  while (!rows_.empty() && rows_.back().report.frame >= report.frame) rows_.pop_back();
  if (rows_.empty()) potentialAtStart_ = report.potentialEnergy;
  if (rows_.size() == 2 * kFrames) rows_.erase(rows_.begin(), rows_.begin() + kFrames);
  rows_.push_back({report, std::nullopt});
}

void FrameTable::SetStretch99(int frame, double stretch99) {
  const auto row = std::lower_bound(rows_.begin(), rows_.end(), frame,
                                    [](const FrameRow& r, int number) { return r.report.frame < number; });
  if (row != rows_.end() && row->report.frame == frame) row->stretch99 = stretch99;
}

std::span<const FrameRow> FrameTable::rows() const {
  return std::span(rows_).last(std::min(rows_.size(), kFrames));
}

Result<std::filesystem::path> ExportFrames(std::span<const FrameRow> rows, const std::filesystem::path& sceneFile) {
  std::filesystem::path stem = sceneFile.stem();
  stem += "-plots";
  const std::filesystem::path file = NumberedName(stem, ".csv");
  std::string text = ReportTableHeader();
  for (const FrameRow& row : rows) text += ReportTableRow(row.report, row.stretch99);
  if (const Status written = WriteFile(file, text); !written) return written.diagnostics();
  return file;
}

}  // namespace percale::viewer
