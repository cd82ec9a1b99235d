#pragma once
/// \file
/// The report of `percale bench fabric` as a page.

#include <string>
#include <utility>
#include <vector>

#include "bench/fabric_bench.h"

namespace percale::cli {

/// One self-contained HTML page: targets, error against time as plots, cost per vertex, and all numbers.
std::string FormatBenchPage(const bench::FabricBench& bench, const std::string& version);

/// The two plots that say most, as files of their own: name and content of each.
std::vector<std::pair<std::string, std::string>> FormatBenchPlots(const bench::FabricBench& bench);

}  // namespace percale::cli
