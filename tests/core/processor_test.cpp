#include "core/processor.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "collide/kernels.h"
#include "fabric/kernels.h"
#include "springs/kernels.h"

using namespace percale;

namespace {

template <class Kernels>
std::vector<std::string> Names(const std::vector<const Kernels*>& kernels) {
  std::vector<std::string> names;
  for (const Kernels* of : kernels) names.emplace_back(of->name);
  return names;
}

}  // namespace

TEST_CASE("all rooms run kernels of the same instruction sets, and of these the best that the processor has") {
  const std::vector<std::string> collide = Names(collide::RunnableKernels());
  CHECK(Names(fabric::RunnableKernels()) == collide);
  CHECK(Names(springs::RunnableKernels()) == collide);
  CHECK(collide.size() == static_cast<std::size_t>(BestInstructionSet()) + 1);
  CHECK(&collide::BestKernels() == collide::RunnableKernels().back());
  CHECK(&fabric::BestKernels() == fabric::RunnableKernels().back());
  CHECK(&springs::BestKernels() == springs::RunnableKernels().back());
  CHECK(&springs::BaselineKernels() == springs::RunnableKernels().front());
}
