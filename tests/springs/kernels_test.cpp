// The inner loops by themselves.

#include "springs/kernels.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <vector>

using namespace percale;
using namespace percale::springs;

TEST_CASE("rows are marked by themselves: what another thread owns is not touched") {
  constexpr std::uint8_t kForeign = 0xc0;  // no kind has these bits
  for (const Kernels* kernels : {&BestKernels(), &BaselineKernels()}) {
    for (const int numWidth : {2, 3, 4, 5, 7}) {
      const int numHeight = 9, count = numWidth * numHeight, front = GridPadding(numWidth);
      // A grid of spacing 2 whose springs are 1 long at rest: all of them are too long.
      std::vector<double> axes[3];
      for (auto& axis : axes) axis.assign(static_cast<std::size_t>(front + count + kGridPad), 0);
      for (int p = 0; p < count; ++p) {
        axes[0][static_cast<std::size_t>(front + p)] = 2 * (p % numWidth);
        axes[1][static_cast<std::size_t>(front + p)] = 2 * (p / numWidth);
      }
      const std::vector<double> rest(static_cast<std::size_t>(count + kGridPad), 1);
      for (int rowBegin = 0; rowBegin < numHeight; ++rowBegin) {
        for (int rowEnd = rowBegin + 1; rowEnd <= numHeight; ++rowEnd) {
          CAPTURE(std::string(kernels->name));
          CAPTURE(numWidth);
          CAPTURE(rowBegin);
          CAPTURE(rowEnd);
          std::vector<std::uint8_t> marks(static_cast<std::size_t>(count), kForeign);
          LongSpringsArgs args{};
          args.numWidth = numWidth;
          args.rowBegin = rowBegin;
          args.rowEnd = rowEnd;
          for (int axis = 0; axis < 3; ++axis) args.x[axis] = axes[axis].data() + front;
          for (const double*& kind : args.rest) kind = rest.data();
          args.limit = 1.1;
          args.longKinds = marks.data();
          const std::int64_t marked = kernels->markLongSprings(args);
          std::int64_t bits = 0;
          for (int p = 0; p < count; ++p) {
            const std::uint8_t mark = marks[static_cast<std::size_t>(p)];
            const bool own = p >= rowBegin * numWidth && p < rowEnd * numWidth;
            REQUIRE((own ? (mark & kForeign) == 0 : mark == kForeign));
            for (int kind = 0; own && kind < 6; ++kind) bits += mark >> kind & 1;
          }
          CHECK(marked == bits);
        }
      }
    }
  }
}
