#pragma once
/// \file
/// The verbs of the program, one file each. All print their own messages and return the exit code.

#include "apps/cli/options.h"

namespace percale::cli {

int View(const Options& options);
int Simulate(const Options& options);
int Shot(const Options& options);
int Render(const Options& options);
int Replay(const Options& options);
int Figures(const Options& options);
int Check(const Options& options);
int CheckIntersections(const Options& options);  ///< check --intersections
int Verify(const Options& options);
int Info(const Options& options);
int Doctor(const Options& options);
int Bench(const Options& options);
int Version();

/// Runs the scene and leaves a picture and a video in the folder out/: what the program does
/// without arguments where there is no display.
int ShowWithoutDisplay(const Options& options);

}  // namespace percale::cli
