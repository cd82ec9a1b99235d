#include "apps/cli/figure_table.h"

#include <iterator>
#include <sstream>

#include "apps/cli/figure_courses.h"
#include "core/text.h"

namespace percale::cli {
namespace {

constexpr int kHalfDown = 40;  // frame in which half of the standing sheet has folded

constexpr const char* kPinned2 = "pinned2";
constexpr const char* kSphere = "sphere";
constexpr const char* kPlane = "plane";

constexpr const char* kNormal = "--shader Normal";
constexpr const char* kWireframe = "--shader Wireframe";

constexpr const char* kCorner = "--camera 25,40,.5 --target .15,1,.85";
constexpr const char* kHanging = "--camera 0,0,1.5 --target .5,.45,.5";  // the course's view, a little nearer
constexpr const char* kDraped = "--camera 25,18,1.35 --target .5,.08,.5";
constexpr const char* kFolding = "--camera 215,20,1.9 --target .5,.34,0";
constexpr const char* kBall = "--camera 20,15,.75 --target .5,.2,.5";
constexpr const char* kDisplaced = "--camera 20,15,1.05 --target .5,.2,.5";  // the ball grows by half

// What puts points back above the plane, as the write-up chose, and what else differs.
constexpr const char* kHold = "simulation.plane_response=hold";
constexpr const char* kHoldLight = "simulation.plane_response=hold cloth.density=10";
constexpr const char* kHoldDense = "simulation.plane_response=hold cloth.density=1000";
constexpr const char* kHoldSoft = "simulation.plane_response=hold cloth.ks=500";

/// The standing sheet as it folds on itself.
constexpr Figure Fold(int number, const char* set, int frame, const char* caption) {
  return {number, "selfCollision", set, frame, kNormal, kFolding, caption};
}

constexpr Figure kFigures[] = {
    {1, kPinned2, "", 0, kWireframe, "--camera 25,35,1.7 --target .5,.95,.5",
     "The springs of the lying sheet at the start: 50 x 50 points, held by two corners."},
    {2, kPinned2, "cloth.enable_shearing=false", 0, kWireframe, kCorner,
     "Without shearing springs: a square grid. The bending springs lie on the structural ones."},
    {3, kPinned2, "cloth.enable_structural=false cloth.enable_bending=false", 0, kWireframe, kCorner,
     "Shearing springs alone: diagonals, with nothing along the edge."},
    {4, kPinned2, "", 0, kWireframe, kCorner, "All springs: the squares and both their diagonals."},
    {5, kPinned2, "cloth.ks=5000 cloth.density=50", kHangingFrames, kNormal, kHanging,
     "ks 5000 N/m at 5 g/cm²: light for its springs, it hangs almost straight."},
    {6, kPinned2, "cloth.ks=5 cloth.density=50000", kHangingFrames, kNormal, kHanging,
     "ks 5 N/m at 5000 g/cm²: springs that carry nothing; only the limit on stretch holds the sheet."},
    {7, kPinned2, "cloth.ks=5000 cloth.density=50000", kHangingFrames, kNormal, kHanging,
     "ks 5000 N/m at 5000 g/cm²: far too heavy for its springs, it sags to the limit and wrinkles."},
    {8, kPinned2, "cloth.density=0", 100, kNormal, "--camera 25,20,1.7 --target .5,.9,.5",
     "Density 0: a sheet without mass has no weight and stays where it started."},
    {9, kPinned2, "cloth.density=500000", kHangingFrames, kNormal, kHanging,
     "Density 50000 g/cm²: the sheet hangs at the limit on stretch, wrinkled."},
    {10, kPinned2, "cloth.ks=100000", kHangingFrames, kNormal, kHanging,
     "ks 100000 N/m: taut, nearly straight between the pins, without creases."},
    {11, kPinned2, "cloth.ks=0", kHangingFrames, kNormal, kHanging,
     "ks 0: no springs at all; the limit on stretch alone holds the sheet together, slack and wrinkled."},
    {12, kPinned2, "", kHangingFrames, kWireframe, kHanging, "The course's values at rest, as springs."},
    {13, kPinned2, "cloth.density=10", kHangingFrames, kNormal, kHanging,
     "Density 1 g/cm²: a light sheet, smooth below a shallow sag."},
    {14, kPinned2, "cloth.damping=0", 120, kNormal, kHanging,
     "Damping 0, 1.3 s after the start: down long ago, and swinging up on the other side in countless waves."},
    {15, kPinned2, "", kHangingFrames, kNormal, kHanging, "The course's values at rest, coloured by normals."},
    {16, kPinned2, "cloth.density=1000", kHangingFrames, kNormal, kHanging,
     "Density 100 g/cm²: a heavy sheet sags deeper, in folds between the pins."},
    {17, kPinned2, "cloth.damping=1", 120, kNormal, kHanging,
     "Damping 1 % per step at the same moment: smooth, and still sinking like a parachute."},
    {18, "pinned4", "", kHangingFrames, kNormal, "--camera 30,20,1.7 --target .5,.87,.5",
     "Held by four corners, at rest, with the course's values."},
    {19, kSphere, "cloth.ks=500", kDrapeFrames, kNormal, kDraped,
     "At rest on the sphere with ks 500 N/m: relaxed, in many narrow folds, hanging lowest."},
    {20, kSphere, "", kDrapeFrames, kNormal, kDraped, "At rest on the sphere with ks 5000 N/m."},
    {21, kSphere, "cloth.ks=50000", kDrapeFrames, kNormal, kDraped,
     "At rest on the sphere with ks 50000 N/m: stiff, in few wide folds, standing off."},
    {22, kPlane, kHold, kPlaneFrames, "--shader Normal --wireframe", "--camera 30,35,2 --target .5,0,.5",
     "At rest on the plane. Flat, the sheet has the plane's normal and with it the plane's colour: its springs are "
     "drawn over it to show where it lies."},
    Fold(23, kHold, 15, "Early: the lower edge of the standing sheet is down, and its rows begin to meet."),
    Fold(24, kHold, 32, "Intermediate: the first folds lie on one another."),
    Fold(25, kHold, 60, "Late: the whole sheet is down, in layers."),
    Fold(26, kHold, 220, "Nearly at rest: the layers have settled and spread."),
    Fold(27, kHoldLight, kHalfDown, "Density 1 g/cm²: few wide waves."),
    Fold(28, kHoldDense, kHalfDown, "Density 100 g/cm²: many narrow waves."),
    Fold(29, kHoldSoft, 20, "ks 500 N/m, 20th frame: narrow waves that crowd low down."),
    Fold(30, kHold, 20, "ks 5000 N/m, 20th frame: wider waves that reach higher."),
    {31, kSphere, "", kDrapeFrames, "--shader Phong --uniform diffuse_on=0 --uniform specular_on=0", kDraped,
     "Blinn-Phong, ambient light alone: one colour, no depth."},
    {32, kSphere, "", kDrapeFrames, "--shader Phong --uniform ambient_on=0 --uniform specular_on=0", kDraped,
     "Blinn-Phong, diffuse light alone: the brighter, the more a place faces the light."},
    {33, kSphere, "", kDrapeFrames, "--shader Phong --uniform ambient_on=0 --uniform diffuse_on=0", kDraped,
     "Blinn-Phong, specular light alone: the highlights."},
    {34, kSphere, "", kDrapeFrames, "--shader Phong", kDraped, "Blinn-Phong, complete: the sum of the three."},
    {35, kSphere, "", kDrapeFrames, "--shader Texture", kDraped, "Our own texture_1.png on the drape."},
    {36, kPinned2, "", kHangingFrames, "--shader Texture", kHanging, "The same texture on the hanging sheet."},
    {37, kSphere, "", 0, "--shader Bump", kBall, "Bump mapping of texture_3.png (bricks) on the sphere."},
    {38, kSphere, "", 30, "--shader Bump", "--camera 20,45,1.5 --target .5,.45,.55",
     "Bump mapping of texture_3.png on the cloth, just before it meets the sphere."},
    {39, kSphere, "", kDrapeFrames, "--shader Bump", kDraped,
     "Bump mapping of texture_3.png: the cloth on the sphere."},
    {40, kSphere, "", 0, "--shader Displacement", kDisplaced,
     "Displacement mapping of texture_3.png on the sphere: the surface itself moves, see its outline."},
    {41, kSphere, "", 0, "--shader Bump -a 16 -o 16", kBall, "Bump mapping, sphere of 16 x 16."},
    {42, kSphere, "", 0, "--shader Bump -a 128 -o 128", kBall, "Bump mapping, sphere of 128 x 128."},
    {43, kSphere, "", 0, "--shader Displacement -a 16 -o 16", kDisplaced, "Displacement mapping, sphere of 16 x 16."},
    {44, kSphere, "", 0, "--shader Displacement -a 128 -o 128", kDisplaced,
     "Displacement mapping, sphere of 128 x 128."},
    {45, kSphere, "", 0, "--shader Mirror", kBall, "Mirror: the sphere reflects the sky and the ground around it."},
    {46, kSphere, "", kDrapeFrames, "--shader Mirror", kDraped, "Mirror: the cloth on the sphere."},
    {47, kPinned2, "", kHangingFrames, "--shader Mirror", kHanging, "Mirror: the hanging sheet."},
    {48, kPinned2, "", kHangingFrames, "--shader Flag --uniform lit=0", kHanging,
     "A shader of our own: the flag of Ukraine by position, without diffuse light."},
    {49, kPinned2, "", kHangingFrames, "--shader Flag", kHanging, "The same flag with diffuse light."},
};
static_assert(std::size(kFigures) == kFigureCount);

constexpr FigurePart kParts[] = {
    {"Part I: Masses and springs",
     "Which structure do the springs have, without the shearing ones, with these alone, and with all?", 1, 4},
    {"Part II: Simulation by numerical integration",
     "What do the spring constant, the density and the damping change, on the way down and at rest?", 5, 18},
    {"Part III: Collisions with other objects",
     "How does the sheet lie on a sphere, for springs of different stiffness, and on a plane?", 19, 22},
    {"Part IV: Self-collisions",
     "How does the sheet fold on itself, how do density and ks change that, and which hash function will do?", 23, 30},
    {"Part V: Shaders",
     "What do the kinds of light add, and how do bump and displacement mapping differ, on spheres coarse and fine?", 31,
     49},
};

std::vector<std::string> Words(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

}  // namespace

std::span<const Figure> AllFigures() {
  return kFigures;
}

std::span<const FigurePart> FigureParts() {
  return kParts;
}

std::string FigureFile(int number) {
  return Text("figure_%02d.png", number);
}

std::string CourseName(const std::string& scene, const std::string& set) {
  return set.empty() ? scene : scene + " " + set;
}

std::vector<std::string> CourseArguments(const std::string& name) {
  std::vector<std::string> words = Words(name);
  std::vector<std::string> arguments = {"scene/" + words[0] + ".json"};
  for (std::size_t i = 1; i < words.size(); ++i) arguments.insert(arguments.end(), {"--set", words[i]});
  return arguments;
}

std::vector<std::string> ShotArguments(const Figure& figure) {
  std::vector<std::string> arguments = CourseArguments(figure.course());
  arguments.insert(arguments.end(), {"--frame", std::to_string(figure.frame)});
  for (const char* options : {figure.look, figure.camera}) {
    for (std::string& word : Words(options)) arguments.push_back(std::move(word));
  }
  return arguments;
}

}  // namespace percale::cli
