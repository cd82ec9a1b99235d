// The kernels of kernels.h. Included by one source file per instruction set, which names the namespace PERCALE_KERNELS
// first. No inline function that other files compile too may be called here: the linker would be free to keep the copy
// that not every processor runs. Templates are safe with a Pack of this namespace's Level.

#include <string.h>

#include "collide/kernels.h"
#include "collide/proximity.h"
#include "math/pack.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace percale::collide::PERCALE_KERNELS {
namespace {

struct Level;
using Doubles = Pack<double, 4, Level>;
using Floats = Pack<float, 4, Level>;

#include "collide/kernel_boxes.h"
#include "collide/kernel_near.h"
#include "collide/kernel_pairs.h"
#include "collide/kernel_search.h"
#include "collide/kernel_shapes.h"
#include "collide/kernel_states.h"
#include "collide/kernel_write.h"

}  // namespace

extern const Kernels kKernels;
const Kernels kKernels = {
    .name = PERCALE_KERNELS_NAME,
    .vertexRows = VertexRows,
    .leafBoxes = LeafBoxes,
    .parentBoxes = ParentBoxes,
    .leafShapes = LeafShapes,
    .triangleShapes = ShapeTriangles,
    .areMonotone = AreMonotone,
    .itemBoxes = ItemBoxes,
    .search = Search,
    .nearItems = FindNearItems,
    .writeVertexTriangle = WriteVertexTriangle,
    .writeEdgeEdge = WriteEdgeEdge,
    .pairStates = PairStates,
};

}  // namespace percale::collide::PERCALE_KERNELS
