#pragma once
/// \file
/// The report of `percale bench fabric` as a page.

#include <string>

#include "bench/fabric_bench.h"

namespace percale::cli {

/// One self-contained HTML page: targets, error against time as plots, cost per vertex, and all numbers.
std::string FormatBenchPage(const bench::FabricBench& bench, const std::string& version);

}  // namespace percale::cli
