#include "apps/viewer/frame_table.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace percale;
using namespace percale::viewer;

namespace {

StepReport Report(int frame) {
  StepReport report;
  report.frame = frame;
  report.potentialEnergy = 100 - frame;
  return report;
}

}  // namespace

TEST_CASE("the last frames are kept, in order, however many there were") {
  FrameTable table;
  CHECK(table.rows().empty());
  for (int frame = 1; frame <= 5000; ++frame) {
    table.Add(Report(frame));
    REQUIRE(table.rows().size() == std::min<std::size_t>(static_cast<std::size_t>(frame), FrameTable::kFrames));
    REQUIRE(table.rows().back().report.frame == frame);
  }
  CHECK(table.rows().front().report.frame == 3801);
  CHECK(table.potentialAtStart() == 99);
}

TEST_CASE("a frame that is simulated again replaces what came after") {
  FrameTable table;
  for (int frame = 1; frame <= 10; ++frame) table.Add(Report(frame));
  table.Add(Report(4));
  REQUIRE(table.rows().size() == 4);
  CHECK(table.rows().back().report.frame == 4);
  table.Add(Report(1));
  CHECK(table.rows().size() == 1);
}

TEST_CASE("the percentile is that of its frame") {
  FrameTable table;
  for (int frame = 3; frame <= 6; ++frame) table.Add(Report(frame));
  table.SetStretch99(5, 1.25);
  table.SetStretch99(2, 9);
  table.SetStretch99(7, 9);
  for (const FrameRow& row : table.rows()) {
    CHECK(row.stretch99.has_value() == (row.report.frame == 5));
    if (row.stretch99) CHECK(*row.stretch99 == 1.25);
  }
}
