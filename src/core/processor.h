#pragma once
/// \file
/// What this machine's processor can run: the one place where an instruction set is chosen.

namespace percale {

/// The sets that kernels are compiled for, each with all of those before it; the last two are the levels of the x86-64
/// psABI with these numbers.
enum class InstructionSet { Baseline, V3, V4 };

/// The best that this processor has, of those that this build has kernels for.
InstructionSet BestInstructionSet();

}  // namespace percale
