// Finding pairs allocates only where there are more than ever before.

#include <doctest/doctest.h>

#include <vector>

#include "collide/pair_finder.h"
#include "core/executor.h"
#include "tests/collide/contact_meshes.h"
#include "tests/count_allocations.h"

using namespace percale;
using namespace percale::test;

TEST_CASE("a search that finds no more pairs than before does not allocate") {
  const Executor executor(1);
  MovingMesh m;
  AddSheet(m, 50, 0.01, 0.0015);
  AddSheet(m, 10, 0.05, 0.0015, true);
  const std::vector<Vec3> flat = m.start;
  SetShape(m, [](const Vec3& p) { return Layers(p, 0.49, 4, 0.002); });
  const ContactMesh mesh = Clustered(m.mesh);
  PairFinder finder(mesh, executor);
  const auto find = [&] { finder.Find(m.Motion(), m.reach, true); };
  CHECK(CountAllocations(find) > 0);
  CHECK(CountAllocations(find) == 0);
  m.start = flat;
  CHECK(CountAllocations(find) == 0);
  const std::size_t memory = finder.MemoryBytes();
  CHECK(memory > finder.edgeEdge().size_bytes());
  SetShape(m, [](const Vec3& p) { return Layers(p, 0.49, 16, 0.002); });
  find();
  CHECK(finder.MemoryBytes() >= memory);
  CHECK(CountAllocations(find) == 0);
}
