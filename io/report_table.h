#pragma once
/// \file
/// What the frames of a run did as a table of numbers, one row each: what `simulate --csv` and the
/// viewer's plots write.

#include <optional>
#include <string>

#include "percale/world.h"

namespace percale {

/// The names of the columns, with their units, and the end of the line:
/// "frame,time_s,kinetic_energy_J,...".
std::string ReportTableHeader();

/// The row of a frame, with the end of the line. `stretch99`: the 99th percentile of the springs'
/// stretch; its place stays empty where that was not measured.
std::string ReportTableRow(const StepReport& report, std::optional<double> stretch99);

}  // namespace percale
