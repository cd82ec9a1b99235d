#pragma once
/// \file
/// A scene: plain data, exactly what a scene file says. The default, unit and range of each value
/// stand beside it; the same facts for programs are in percale/parameters.h.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "percale/rest_mesh.h"
#include "percale/vec3.h"
#include "percale/vertex_cache.h"

namespace percale {

/// A point of a cloth's grid: column i along the width, row j along the height. Of a cloth that is no grid: vertex i,
/// and j is 0; vertices of a mesh are counted as in its file, from 0.
struct GridPoint {
  int i = 0, j = 0;
  friend bool operator==(const GridPoint&, const GridPoint&) = default;
};

/// How cloth is computed: as masses and springs, or as a continuum of measured stiffness.
enum class Engine { Springs, Fabric };
/// What a cloth is cut as. Engine::Springs knows grids only.
enum class Shape { Grid, Disc, Mesh };
enum class Orientation { Horizontal = 0, Vertical = 1 };
/// How a point's box becomes a bucket of the spatial map. The course's write-up proposes `Linear`
/// (7x + 5y + 3z) and `Powers` (x^6 + y^4 + z^2), which let boxes share a bucket; `Exact` keeps one
/// bucket per box; `Brute` compares every point with every other.
enum class HashFunction { Exact, Linear, Powers, Brute };
/// Where a point that crossed a plane is put: on its trajectory just above the plane, above its
/// foot on the plane, or back where it was.
enum class PlaneResponse { Interpolate, Offset, Hold };
/// Which tangents a cloth is drawn with: the course's constant (1, 0, 0), or along growing u.
enum class Tangents { Constant, FromUv };

/// Materials with known constants, see percale/fabrics.h.
enum class Fabric { Cotton, Wool, WoolLycra, Polyester, Silk, Denim, Leather, Felt };
enum class MembraneLaw { StVenantKirchhoff, NeoHookean };
/// Bending by the second derivatives of the sheet, which are linear in the positions: for sheets that are flat at
/// rest and hardly stretch. Or by the angles between triangles: any rest shape, and plastic folds.
enum class BendingLaw { Quadratic, Hinges };
/// The shape that BendingLaw::Hinges bends back to.
enum class RestAngles { Flat, Start };

/// What a collider is. In its own frame it lies around the origin, its axis along y.
enum class ColliderShape { Sphere, Plane, Box, Capsule, Cylinder, Cone, Torus, Mesh };

struct ClothSettings {
  Shape shape = Shape::Grid;
  double width = 1;                                   ///< Extent [m], > 0.
  double height = 1;                                  ///< Extent [m], > 0.
  int numWidthPoints = 50;                            ///< Grid points along the width, >= 2.
  int numHeightPoints = 50;                           ///< Grid points along the height, >= 2.
  double thickness = 0.0095;                          ///< Points of cloth keep 2 * thickness apart [m], >= 0.
  Orientation orientation = Orientation::Horizontal;  ///< Lies at y = 1 over x, z; or stands in x, y. Not of a mesh.
  Vec3 origin;                                        ///< Moves the whole sheet [m].
  std::vector<GridPoint> pinned;                      ///< Immovable points.
  std::string pinnedGroup;                            ///< More of them: all vertices of this group of the mesh.
  bool enableStructural = true;                       ///< Springs to the left and upper neighbours.
  bool enableShearing = true;                         ///< Springs to the upper left and upper right neighbours.
  bool enableBending = true;                          ///< Springs to the second neighbours left and up.
  double damping = 0.2;                               ///< Share of the velocity lost per step [%], 0..100.
  double density = 150;                               ///< Areal density [kg/m^2], >= 0.
  double ks = 5000;                                   ///< Spring constant [N/m], >= 0.
  int seed = 184;                                     ///< Of the vertical sheet's random z.

  // The continuum: Engine::Fabric.
  double radius = 0.5;                       ///< Of a disc [m], > 0.
  int rings = 30;                            ///< Of a disc's triangles, >= 1.
  std::string mesh;                          ///< File of a mesh; the path begins at the folder of the scene's file.
  double meshScale = 1;                      ///< Metres per unit of that file, > 0.
  RestShape restShape = RestShape::Space;    ///< Where the mesh has its shape at rest.
  double metresPerUv = 1;                    ///< Size of its texture [m], > 0.
  bool weld = false;                         ///< Vertices that lie together become one, which closes seams.
  double weldDistance = 0;                   ///< Farthest that they lie apart [m]; 0, or >= 1e-9.
  std::shared_ptr<const LoadedMesh> loaded;  ///< That file, read: see LoadMeshes in percale/scene_file.h.
  Vec3 rotation;                   ///< Turns it about x, then y, then z, around the middle of its box [degree].
  Fabric fabric = Fabric::Cotton;  ///< What the constants below came from; any of them may differ.
  double stretchWarp = 261;        ///< Force per width and strain along the warp, u [N/m], > 0.
  double stretchWeft = 261;        ///< The same along the weft, v [N/m], > 0.
  double poissonRatio = 0.243;     ///< Narrowing over lengthening when pulled along the warp, -1..1.
  double shear = 105;              ///< Shear modulus times thickness [N/m], > 0.
  double bendWarp = 1.2e-5;        ///< Moment per width and curvature along the warp [N m], >= 0.
  double bendWeft = 1.2e-5;        ///< The same along the weft [N m], >= 0.
  double stretchDamping = 0.002;   ///< Of strain rates, as a time: stress = stiffness (strain + this * rate) [s], >= 0.
  double bendDamping = 0.002;      ///< The same for curvature [s], >= 0.
  double foldYield = 0;        ///< BendingLaw::Hinges: curvature beyond which a fold sets [1/m], >= 0; 0: none does.
  double foldHardening = 0;    ///< Growth of the angle that a fold bears by the angle that has set, >= 0.
  double strainLimit = 0.2;    ///< Strain from which the yarns lock: the stress grows with its square, > 0.
  double warpAngle = 0;        ///< Of the warp, turned from u towards v [degree].
  double pressure = 0;         ///< Inside of a closed cloth above the outside [Pa].
  double contactDistance = 0;  ///< Cloth pushes back what comes nearer [m], >= 0; 0: 0.3 of its mean edge.
  double friction = 0.3;       ///< Of cloth on cloth, Coulomb's coefficient, >= 0.
  MembraneLaw membraneLaw = MembraneLaw::StVenantKirchhoff;
  BendingLaw bendingLaw = BendingLaw::Quadratic;
  RestAngles restAngles = RestAngles::Flat;

  Vec3 color{1, 1, 1};      ///< Of the front, times the look's base colour, 0..1 each.
  Vec3 backColor{1, 1, 1};  ///< The same of the back, where a shader tells the sides apart.
};

struct SphereSettings {
  Vec3 origin;            ///< Centre [m].
  double radius = 0.2;    ///< [m], > 0.
  double friction = 0.3;  ///< Share of the correction that is withheld, 0..1. Engine::Fabric: Coulomb's coefficient.
};

struct PlaneSettings {
  Vec3 point;             ///< Any point of the plane [m].
  Vec3 normal{0, 1, 0};   ///< Not zero; need not have length 1.
  double friction = 0.5;  ///< Share of the correction that is withheld, 0..1. Engine::Fabric: Coulomb's coefficient.
};

/// Something solid that cloth does not enter. Engine::Fabric.
struct ColliderSettings {
  ColliderShape shape = ColliderShape::Sphere;
  Vec3 position;             ///< Of its centre [m]; any point of a plane; of a mesh the origin of its file.
  Vec3 rotation;             ///< Turns it about x, then y, then z, around its position [degree].
  Vec3 size{0.4, 0.4, 0.4};  ///< Edges of a box [m], > 0 each.
  double radius = 0.2;       ///< Of a sphere, capsule, cylinder, a cone's base, the ring of a torus [m], > 0.
  double length = 0.4;       ///< Along y of a cylinder or cone, of a capsule between its balls' centres [m], > 0.
  double tubeRadius = 0.05;  ///< Of the tube of a torus [m], > 0, < radius.
  std::string mesh;          ///< File of a mesh; the path begins at the folder of the scene's file.
  double meshScale = 1;      ///< Metres per unit of that file, > 0.
  std::string cache;         ///< File of samples by which the mesh's vertices move, .pc2 or .mdd; empty: they do not.
  double cacheRate = 0;      ///< Its samples per second [1/s], >= 0; 0: as the file states.
  double cacheStart = 0;     ///< When its first sample is due [s].
  bool twoSided = false;     ///< Of an open mesh: cloth stays out from both sides, not only in front.
  double friction = 0.3;     ///< Coulomb's coefficient, 0..10.
  double thickness = 0;      ///< Cloth keeps so much farther off [m], >= 0.
  Vec3 color{1, 1, 1};       ///< Times the look's base colour, 0..1 each.
  std::shared_ptr<const LoadedMesh> loaded;        ///< That file, read, its triangles turned outwards: see LoadMeshes.
  std::shared_ptr<const VertexCache> loadedCache;  ///< The file of the cache, read for that mesh.
};

/// A part of one cloth whose material differs: its triangles with all corners in `group` and in `rectangle`. Several
/// patches of a triangle multiply.
struct Patch {
  int cloth = 0;                     ///< Index of the cloth in the scene.
  std::string group;                 ///< Vertices of the mesh; empty: all of the cloth's.
  std::vector<GridPoint> rectangle;  ///< Two opposite corners of a part of the grid; none: all of it.
  double stretch = 1;                ///< Times stretchWarp, stretchWeft and shear, > 0.
  double bend = 1;                   ///< Times bendWarp and bendWeft, >= 0.
  double density = 1;                ///< Times the density, > 0.
};

/// Ropes from points of one cloth to a place: slack up to their length, springs beyond it. Engine::Fabric.
struct Tether {
  int cloth = 0;                  ///< Index of the cloth in the scene.
  std::vector<GridPoint> points;  ///< Each on a rope of its own; at least one.
  Vec3 anchor;                    ///< [m]
  double length = 0;              ///< [m], >= 0.
  double stiffness = 1e4;         ///< Force per way beyond the length [N/m], > 0.
};

/// Carries some pins of one cloth: at rest before `start`, displaced by `displacement` and turned by `angle` from `end`
/// on, smoothly in between. Of several motions of a pin the displacements add up; the turns follow one another in
/// their order, each about its centre, which the displacements carry along.
struct PinMotion {
  int cloth = 0;                  ///< Index of the cloth in the scene.
  std::vector<GridPoint> points;  ///< Pinned points that move; none: all of the cloth's pins.
  double start = 0;               ///< [s]
  double end = 1;                 ///< [s], > start.
  Vec3 displacement;              ///< [m]
  Vec3 axis{0, 1, 0};             ///< Not zero; need not have length 1.
  double angle = 0;               ///< About the axis, counter-clockwise seen from its tip; more than a turn [degree].
  Vec3 centre{};                  ///< A point of the axis [m].
  bool steady = false;            ///< At constant speed from start to end, not smoothly from rest to rest.
};

/// The same for a collider.
struct ColliderMotion {
  int collider = 0;       ///< Index among Scene::colliders.
  double start = 0;       ///< [s]
  double end = 1;         ///< [s], > start.
  Vec3 displacement;      ///< [m]
  Vec3 axis{0, 1, 0};     ///< Not zero; need not have length 1.
  double angle = 0;       ///< About the axis, counter-clockwise seen from its tip; more than a turn [degree].
  bool ownCentre = true;  ///< The axis runs through the collider's position; ignore `centre`.
  Vec3 centre{};          ///< A point of the axis [m].
  bool steady = false;    ///< At constant speed from start to end, not smoothly from rest to rest.
  bool jump = false;      ///< All at once at `end`, with no way between: cloth there is not swept along but pulled out.
};

/// Engine::Springs: a viscous wind after Provot 1995, section 3.2: each point feels
/// drag * area * (n . (wind - velocity)) n, n the cloth's unit normal. Engine::Fabric: drag and lift of each
/// triangle by the square of the speed, after Wilson, McNeal et al. 2014.
struct WindSettings {
  Vec3 velocity;                 ///< Of the air [m/s].
  double drag = 0;               ///< [kg/(m^2 s)], >= 0; 0: still air that resists nothing.
  double gustiness = 0;          ///< The speed swings by this share of itself, 0..1.
  double gustPeriod = 1;         ///< [s], > 0.
  double airDensity = 1.2;       ///< [kg/m^3], >= 0; 0: no air.
  double dragCoefficient = 1.2;  ///< Of a sheet across the wind, >= 0.
  double liftCoefficient = 0;    ///< Of a sheet aslant, beyond that of a flat plate, >= 0.
};

struct SimulationSettings {
  Engine engine = Engine::Springs;
  int framesPerSecond = 90;   ///< >= 1.
  int stepsPerFrame = 30;     ///< >= 1.
  Vec3 gravity{0, -9.8, 0};   ///< [m/s^2]
  bool selfCollision = true;  ///< Points of cloth keep apart, within a cloth and between cloths.
  HashFunction hash = HashFunction::Exact;
  PlaneResponse planeResponse = PlaneResponse::Interpolate;
  int newtonIterations = 3;  ///< Engine::Fabric: at most so many per step, >= 1.
  int linearIterations = 6;  ///< Engine::Fabric: so many times that at most in all of those, >= 1.
  double tolerance = 1e-3;   ///< Engine::Fabric: a step is converged when the next correction would be this
                             ///< share of its first, > 0.
};

/// Where the picture is taken from. By default the camera sees the cloth as the course does.
struct CameraSettings {
  bool automatic = true;  ///< Ignore the rest: target and distance follow from the cloths.
  Vec3 target;            ///< Point looked at [m].
  double distance = 1.8;  ///< From the target [m], > 0.
  double azimuth = 0;     ///< Turn about +y [degree]; 0 looks along -z.
  double elevation = 0;   ///< Above the horizon [degree], -89..89.
};

struct LookSettings {
  std::string shader = "Wireframe";  ///< Name of a file shaders/NAME.frag.
  Vec3 color{1, 1, 1};               ///< Base colour of cloths and spheres, 0..1 each.
  double normalScaling = 2;          ///< Bump strength.
  double heightScaling = 0.1;        ///< Displacement strength.
  Tangents tangents = Tangents::Constant;
};

struct Scene {
  std::string name;  ///< The file's path as given, for messages.
  SimulationSettings simulation;
  std::vector<ClothSettings> cloths;
  std::vector<SphereSettings> spheres;
  std::vector<PlaneSettings> planes;
  std::vector<ColliderSettings> colliders;
  std::vector<Patch> patches;
  std::vector<Tether> tethers;
  std::vector<PinMotion> pinMotions;
  std::vector<ColliderMotion> colliderMotions;
  WindSettings wind;
  CameraSettings camera;
  LookSettings look;
  bool planesFirst = false;  ///< Colliders act in file order: all planes before all spheres, or after.

  double TimeStep() const {  ///< Of one step [s].
    return 1.0 / (double(simulation.framesPerSecond) * double(simulation.stepsPerFrame));
  }
};

}  // namespace percale
