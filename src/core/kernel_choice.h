// Which of a room's kernels this processor runs. Included by kernels.cpp of each room inside the room's namespace,
// after its own kernels.h and core/processor.h; never elsewhere.

namespace baseline {
extern const Kernels kKernels;
}
#if defined(PERCALE_X86_KERNELS)
namespace v3 {
extern const Kernels kKernels;
}
namespace v4 {
extern const Kernels kKernels;
}
#endif

std::vector<const Kernels*> RunnableKernels() {
  std::vector<const Kernels*> kernels = {&baseline::kKernels};
#if defined(PERCALE_X86_KERNELS)
  const InstructionSet best = BestInstructionSet();
  if (best >= InstructionSet::V3) kernels.push_back(&v3::kKernels);
  if (best >= InstructionSet::V4) kernels.push_back(&v4::kKernels);
#endif
  return kernels;
}

const Kernels& BestKernels() {
  static const Kernels& best = *RunnableKernels().back();
  return best;
}
