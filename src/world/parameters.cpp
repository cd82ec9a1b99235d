#include "percale/parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include "core/text.h"
#include "percale/fabrics.h"

namespace percale {
namespace {

// Bounds beyond any use, which keep sums and products of values finite.
constexpr double kFarthest = 1e6;    // [m]
constexpr double kMostPoints = 1e6;  // along one side of a grid
constexpr double kMostSteps = 1e5;   // frames per second, and steps per frame
constexpr double kLatest = 1e6;      // [s]
constexpr double kMostDegrees = 1e6;
constexpr double kLargestInt = 2147483647;
/// Messages leave out a bound beyond this until a value breaks it: nobody asks for less than 1e12 N/m.
constexpr double kWorthNaming = 1e4;

// Names of the values of each enumeration, in the enumeration's order.
constexpr std::string_view kEngines[] = {"springs", "fabric"};
constexpr std::string_view kHashFunctions[] = {"exact", "linear", "powers", "brute"};
constexpr std::string_view kPlaneResponses[] = {"interpolate", "offset", "hold"};
constexpr std::string_view kTangents[] = {"constant", "from_uv"};
constexpr std::string_view kShapes[] = {"grid", "disc", "mesh"};
constexpr std::string_view kColliderShapes[] = {"sphere",   "plane", "box",   "capsule",
                                                "cylinder", "cone",  "torus", "mesh"};
constexpr std::string_view kRestShapes[] = {"space", "texture"};
constexpr std::string_view kOrientations[] = {"horizontal", "vertical"};
constexpr std::string_view kFabricNames[] = {"cotton", "wool",  "wool_lycra", "polyester",
                                             "silk",   "denim", "leather",    "felt"};
constexpr std::string_view kMembraneLaws[] = {"st_venant_kirchhoff", "neo_hookean"};
constexpr std::string_view kRestAngles[] = {"flat", "start"};
constexpr std::string_view kBendingLaws[] = {"quadratic", "hinges"};

constexpr std::span<const std::string_view> NamesOf(Engine) {
  return kEngines;
}
constexpr std::span<const std::string_view> NamesOf(HashFunction) {
  return kHashFunctions;
}
constexpr std::span<const std::string_view> NamesOf(PlaneResponse) {
  return kPlaneResponses;
}
constexpr std::span<const std::string_view> NamesOf(Tangents) {
  return kTangents;
}
constexpr std::span<const std::string_view> NamesOf(Shape) {
  return kShapes;
}
constexpr std::span<const std::string_view> NamesOf(ColliderShape) {
  return kColliderShapes;
}
constexpr std::span<const std::string_view> NamesOf(RestShape) {
  return kRestShapes;
}
constexpr std::span<const std::string_view> NamesOf(Orientation) {
  return kOrientations;
}
constexpr std::span<const std::string_view> NamesOf(Fabric) {
  return kFabricNames;
}
constexpr std::span<const std::string_view> NamesOf(MembraneLaw) {
  return kMembraneLaws;
}
constexpr std::span<const std::string_view> NamesOf(RestAngles) {
  return kRestAngles;
}
constexpr std::span<const std::string_view> NamesOf(BendingLaw) {
  return kBendingLaws;
}

/// What the table says about a parameter beside where it lives.
struct Facts {
  std::string_view name, label, unit = {};
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool minExclusive = false;
  bool required = false;
  double typicalMin = 0, typicalMax = 0;
  bool logarithmic = false;
  std::optional<Effect> effect = {};  ///< Nothing: the group's.
  std::optional<Engine> engine = {};
  std::string_view help = {};
};

template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};

/// The member `Field` of the object `index` of `Owner`, a member of Scene: one object or a vector.
template <auto Owner, auto Field, class AnyScene>
auto& Access(AnyScene& scene, std::size_t index) {
  auto& owner = scene.*Owner;
  if constexpr (IsVector<std::remove_cvref_t<decltype(owner)>>::value)
    return owner[index].*Field;
  else
    return owner.*Field;
}

/// The value of the file for a member of the scene, and back.
template <auto Owner, auto Field>
Value Get(const Scene& scene, std::size_t index) {
  const auto& member = Access<Owner, Field>(scene, index);
  using T = std::remove_cvref_t<decltype(member)>;
  if constexpr (std::is_same_v<T, Orientation>)
    return static_cast<double>(member);
  else if constexpr (std::is_enum_v<T>)
    return std::string(NamesOf(T{})[static_cast<std::size_t>(member)]);
  else if constexpr (std::is_same_v<T, int>)
    return static_cast<double>(member);
  else
    return member;
}

template <auto Owner, auto Field>
void Set(Scene& scene, std::size_t index, const Value& value) {
  auto& member = Access<Owner, Field>(scene, index);
  using T = std::remove_cvref_t<decltype(member)>;
  if constexpr (std::is_same_v<T, int> || std::is_same_v<T, Orientation>) {
    member = static_cast<T>(std::get<double>(value));
  } else if constexpr (std::is_enum_v<T>) {
    const auto names = NamesOf(T{});
    member = static_cast<T>(std::find(names.begin(), names.end(), std::get<std::string>(value)) - names.begin());
  } else {
    member = std::get<T>(value);
  }
}

template <class T>
constexpr ValueKind KindOf() {
  if constexpr (std::is_same_v<T, double>)
    return ValueKind::Number;
  else if constexpr (std::is_same_v<T, int> || std::is_same_v<T, Orientation>)
    return ValueKind::Integer;
  else if constexpr (std::is_same_v<T, bool>)
    return ValueKind::Boolean;
  else if constexpr (std::is_enum_v<T>)
    return ValueKind::Choice;
  else if constexpr (std::is_same_v<T, std::string>)
    return ValueKind::Text;
  else if constexpr (std::is_same_v<T, Vec3>)
    return ValueKind::Vector;
  else {
    static_assert(std::is_same_v<T, std::vector<GridPoint>>);
    return ValueKind::GridPoints;
  }
}

/// Makes the row of the table for `Owner.*Field`; its kind and choices follow from the member's type.
template <auto Owner, auto Field>
struct RowOf {
  std::string_view group;
  Effect effect = Effect::Live;

  Parameter operator()(const Facts& f) const {
    using T = std::remove_cvref_t<decltype(Access<Owner, Field>(std::declval<Scene&>(), 0))>;
    std::span<const std::string_view> choices;
    if constexpr (std::is_enum_v<T>) choices = NamesOf(T{});
    return {group,
            f.name,
            f.label,
            KindOf<T>(),
            f.unit,
            f.min,
            f.max,
            f.minExclusive,
            f.required,
            f.typicalMin,
            f.typicalMax,
            f.logarithmic,
            f.help,
            choices,
            f.effect.value_or(effect),
            f.engine,
            &Get<Owner, Field>,
            &Set<Owner, Field>};
  }
};

/// The same row, with what a choice of it brings along.
Parameter WithChoice(Parameter row, void (*choose)(Scene&, std::size_t, const Value&)) {
  row.choose = choose;
  return row;
}

void ChooseFabric(Scene& scene, std::size_t index, const Value& value) {
  Set<&Scene::cloths, &ClothSettings::fabric>(scene, index, value);
  SetFabric(scene.cloths[index], scene.cloths[index].fabric);
}

/// Another engine: the steps and the cloths that it is made for.
void ChooseEngine(Scene& scene, std::size_t index, const Value& value) {
  SimulationSettings& simulation = scene.simulation;
  const Engine before = simulation.engine;
  Set<&Scene::simulation, &SimulationSettings::engine>(scene, index, value);
  if (simulation.engine == before) return;
  const bool fabric = simulation.engine == Engine::Fabric;
  const SimulationSettings springs;
  simulation.framesPerSecond = fabric ? 60 : springs.framesPerSecond;
  simulation.stepsPerFrame = fabric ? 1 : springs.stepsPerFrame;
  for (ClothSettings& cloth : scene.cloths) {
    if (fabric)
      SetFabric(cloth, cloth.fabric);
    else
      cloth.density = ClothSettings().density;
  }
}

/// Who states a centre does not want the collider's own, unless they say so.
void ChooseCentre(Scene& scene, std::size_t index, const Value& value) {
  Set<&Scene::colliderMotions, &ColliderMotion::centre>(scene, index, value);
  scene.colliderMotions[index].ownCentre = false;
}

template <auto Field>
constexpr RowOf<&Scene::cloths, Field> Cloth{"cloth"};
template <auto Field>
constexpr RowOf<&Scene::spheres, Field> Sphere{"sphere"};
template <auto Field>
constexpr RowOf<&Scene::planes, Field> Plane{"plane"};
template <auto Field>
constexpr RowOf<&Scene::colliders, Field> Collider{"collider"};
template <auto Field>
constexpr RowOf<&Scene::patches, Field> PatchOf{"patch"};
template <auto Field>
constexpr RowOf<&Scene::tethers, Field> TetherOf{"tether"};
template <auto Field>
constexpr RowOf<&Scene::pinMotions, Field> Motion{"pin_motion"};
template <auto Field>
constexpr RowOf<&Scene::colliderMotions, Field> Turn{"collider_motion"};
template <auto Field>
constexpr RowOf<&Scene::wind, Field> Wind{"wind"};
template <auto Field>
constexpr RowOf<&Scene::simulation, Field> Simulation{"simulation"};
template <auto Field>
constexpr RowOf<&Scene::camera, Field> Camera{"camera", Effect::View};
template <auto Field>
constexpr RowOf<&Scene::look, Field> Look{"look", Effect::View};

// clang-format off
std::vector<Parameter> MakeTable() {
  constexpr Effect kRebuild = Effect::Rebuild;
  constexpr Engine kSprings = Engine::Springs, kFabric = Engine::Fabric;
  using C = ClothSettings;
  using O = ColliderSettings;
  using M = ColliderMotion;
  using S = SimulationSettings;
  return {
    Cloth<&C::shape>({.name = "shape", .label = "Shape", .effect = kRebuild, .engine = kFabric,
      .help = "grid: a rectangle of `width` and `height`; disc: of `radius`; mesh: from the file `mesh`."}),
    Cloth<&C::width>({.name = "width", .label = "Width", .unit = "m", .min = 0, .max = kFarthest,
      .minExclusive = true, .required = true,
      .typicalMin = 0.1, .typicalMax = 4, .effect = kRebuild, .help = "Extent of the sheet along x."}),
    Cloth<&C::height>({.name = "height", .label = "Height", .unit = "m", .min = 0, .max = kFarthest,
      .minExclusive = true, .required = true,
      .typicalMin = 0.1, .typicalMax = 4, .effect = kRebuild,
      .help = "Extent of the sheet along z when it lies, along y when it stands."}),
    Cloth<&C::numWidthPoints>({.name = "num_width_points", .label = "Points along width", .min = 2,
      .max = kMostPoints, .required = true,
      .typicalMin = 2, .typicalMax = 200, .effect = kRebuild,
      .help = "Grid points along the width; the course uses 50."}),
    Cloth<&C::numHeightPoints>({.name = "num_height_points", .label = "Points along height", .min = 2,
      .max = kMostPoints, .required = true,
      .typicalMin = 2, .typicalMax = 200, .effect = kRebuild,
      .help = "Grid points along the height; the course uses 50."}),
    Cloth<&C::thickness>({.name = "thickness", .label = "Thickness", .unit = "m", .min = 0, .max = kFarthest,
      .required = true,
      .typicalMin = 0, .typicalMax = 0.02,
      .help = "Points of cloth keep twice this apart; at most half the grid's spacing, or the sheet swells."}),
    Cloth<&C::orientation>({.name = "orientation", .label = "Orientation", .min = 0, .max = 1, .required = true,
      .effect = kRebuild,
      .help = "0: the sheet lies at y = 1 over x, z. 1: it stands in x, y, with a slight random z. A mesh is as in its file."}),
    Cloth<&C::origin>({.name = "origin", .label = "Origin", .unit = "m", .min = -kFarthest, .max = kFarthest,
      .typicalMin = -2, .typicalMax = 2, .effect = kRebuild, .help = "Moves the whole sheet."}),
    Cloth<&C::pinned>({.name = "pinned", .label = "Pinned points",
      .help = "Immovable points, each as [i, j]: column along the width, row along the height, from 0; or as a number v, which is [v, 0]: vertex v of a disc or mesh."}),
    Cloth<&C::pinnedGroup>({.name = "pinned_group", .label = "Pinned group", .engine = kFabric,
      .help = "Pins all vertices of this group of the mesh as well; groups are what its file names by g or o."}),
    Cloth<&C::enableStructural>({.name = "enable_structural", .label = "Structural", .required = true,
      .engine = kSprings, .help = "Springs to the neighbours left and up."}),
    Cloth<&C::enableShearing>({.name = "enable_shearing", .label = "Shearing", .required = true,
      .engine = kSprings, .help = "Springs to the diagonal neighbours."}),
    Cloth<&C::enableBending>({.name = "enable_bending", .label = "Bending", .required = true,
      .engine = kSprings, .help = "Springs, five times weaker, to the second neighbours left and up."}),
    Cloth<&C::damping>({.name = "damping", .label = "Damping", .unit = "%", .min = 0, .max = 100, .required = true,
      .typicalMin = 0, .typicalMax = 1,
      .engine = kSprings, .help = "Share of the velocity lost per step; 0.2 settles in seconds, 1 falls like a parachute."}),
    Cloth<&C::density>({.name = "density", .label = "Density", .unit = "kg/m^2", .min = 0, .max = 1e9, .required = true,
      .typicalMin = 1, .typicalMax = 500000, .logarithmic = true,
      .help = "Mass per area; the course uses 150, which its panel shows as 15 g/cm^2."}),
    Cloth<&C::ks>({.name = "ks", .label = "Spring constant", .unit = "N/m", .min = 0, .max = 1e12, .required = true,
      .typicalMin = 1, .typicalMax = 100000, .logarithmic = true,
      .engine = kSprings, .help = "Stiffness of the springs; 500 sags like a net, 5000 like cloth, 50000 is stiff."}),
    Cloth<&C::seed>({.name = "seed", .label = "Seed", .min = 0, .max = kLargestInt,
      .typicalMin = 0, .typicalMax = 1000, .effect = kRebuild, .help = "Of the standing sheet's random z."}),
    Cloth<&C::radius>({.name = "radius", .label = "Radius", .unit = "m", .min = 0, .max = kFarthest, .minExclusive = true,
      .typicalMin = 0.1, .typicalMax = 2, .effect = kRebuild, .engine = kFabric,
      .help = "Of a disc, which lies or stands around (0, 1, 0)."}),
    Cloth<&C::rings>({.name = "rings", .label = "Rings", .min = 1, .max = 6000,
      .typicalMin = 2, .typicalMax = 100, .effect = kRebuild, .engine = kFabric,
      .help = "Of a disc's triangles around its middle, which is vertex 0; ring k has 6 k vertices from 1 + 3 k (k - 1) on."}),
    Cloth<&C::mesh>({.name = "mesh", .label = "Mesh", .effect = kRebuild, .engine = kFabric,
      .help = "File of a mesh, .obj or .ply; the path begins at the folder of the scene's file."}),
    Cloth<&C::meshScale>({.name = "mesh_scale", .label = "Mesh scale", .unit = "m", .min = 0, .max = 1e6, .minExclusive = true,
      .typicalMin = 0.001, .typicalMax = 10, .logarithmic = true, .effect = kRebuild, .engine = kFabric,
      .help = "Length of one unit of the mesh's file; 0.01 where it is in centimetres."}),
    Cloth<&C::restShape>({.name = "rest_shape", .label = "Rest shape", .effect = kRebuild, .engine = kFabric,
      .help = "Where the mesh is at rest: space: as its vertices lie; texture: flat, as its texture coordinates lie."}),
    Cloth<&C::metresPerUv>({.name = "metres_per_uv", .label = "Metres per uv", .unit = "m", .min = 0, .max = 1e6, .minExclusive = true,
      .typicalMin = 0.1, .typicalMax = 10, .logarithmic = true, .effect = kRebuild, .engine = kFabric,
      .help = "Length of one unit of the texture, where that is the rest shape."}),
    Cloth<&C::weld>({.name = "weld", .label = "Weld", .effect = kRebuild, .engine = kFabric,
      .help = "Makes vertices of the mesh that lie together one, which closes seams."}),
    Cloth<&C::weldDistance>({.name = "weld_distance", .label = "Weld distance", .unit = "m", .min = 0, .max = 1e3,
      .typicalMin = 0, .typicalMax = 0.01, .effect = kRebuild, .engine = kFabric,
      .help = "Farthest that such vertices lie apart; 0 for those at the same place."}),
    Cloth<&C::rotation>({.name = "rotation", .label = "Rotation", .unit = "degree", .min = -360, .max = 360,
      .typicalMin = -180, .typicalMax = 180, .effect = kRebuild, .engine = kFabric,
      .help = "Turns the cloth about x, then y, then z, around the middle of its box."}),
    WithChoice(Cloth<&C::fabric>({.name = "fabric", .label = "Fabric", .engine = kFabric,
      .help = "Material; sets density, stiffness and damping to what was measured, and any of them may be changed."}),
      &ChooseFabric),
    Cloth<&C::stretchWarp>({.name = "stretch_warp", .label = "Stretch, warp", .unit = "N/m", .min = 0, .max = 1e9,
      .minExclusive = true, .typicalMin = 10, .typicalMax = 10000, .logarithmic = true, .engine = kFabric,
      .help = "Force per width and strain along the warp; wool 97, cotton 261, leather 4000."}),
    Cloth<&C::stretchWeft>({.name = "stretch_weft", .label = "Stretch, weft", .unit = "N/m", .min = 0, .max = 1e9,
      .minExclusive = true, .typicalMin = 10, .typicalMax = 10000, .logarithmic = true, .engine = kFabric,
      .help = "The same along the weft, across the warp."}),
    Cloth<&C::poissonRatio>({.name = "poisson_ratio", .label = "Poisson ratio", .min = -0.99, .max = 0.99,
      .typicalMin = 0, .typicalMax = 0.5, .engine = kFabric,
      .help = "Narrowing over lengthening when pulled along the warp; cotton 0.24."}),
    Cloth<&C::shear>({.name = "shear", .label = "Shear", .unit = "N/m", .min = 0, .max = 1e9, .minExclusive = true,
      .typicalMin = 5, .typicalMax = 5000, .logarithmic = true, .engine = kFabric,
      .help = "Force per width and angle of shear; a loose weave 30, cotton 105."}),
    Cloth<&C::bendWarp>({.name = "bend_warp", .label = "Bend, warp", .unit = "N m", .min = 0, .max = 1e3,
      .typicalMin = 1e-6, .typicalMax = 1e-2, .logarithmic = true, .engine = kFabric,
      .help = "Moment per width and curvature along the warp; silk 4e-6, cotton 1.2e-5, denim 2e-4."}),
    Cloth<&C::bendWeft>({.name = "bend_weft", .label = "Bend, weft", .unit = "N m", .min = 0, .max = 1e3,
      .typicalMin = 1e-6, .typicalMax = 1e-2, .logarithmic = true, .engine = kFabric,
      .help = "The same along the weft, across the warp."}),
    Cloth<&C::stretchDamping>({.name = "stretch_damping", .label = "Stretch damping", .unit = "s", .min = 0, .max = 1e3,
      .typicalMin = 0, .typicalMax = 0.05, .engine = kFabric,
      .help = "Stress is stiffness times (strain + this time its rate); it leaves rigid motion alone."}),
    Cloth<&C::bendDamping>({.name = "bend_damping", .label = "Bend damping", .unit = "s", .min = 0, .max = 1e3,
      .typicalMin = 0, .typicalMax = 0.05, .engine = kFabric,
      .help = "The same for bending."}),
    Cloth<&C::foldYield>({.name = "fold_yield", .label = "Fold yield", .unit = "1/m", .min = 0, .max = 1e6,
      .typicalMin = 0, .typicalMax = 1000, .engine = kFabric,
      .help = "Curvature beyond which a fold stays, with bending_law hinges; 0: none does; paper 30, a crease in cotton 300."}),
    Cloth<&C::foldHardening>({.name = "fold_hardening", .label = "Fold hardening", .min = 0, .max = 1e3,
      .typicalMin = 0, .typicalMax = 2, .engine = kFabric,
      .help = "How much more angle a fold bears per angle that has set; 0: no more."}),
    Cloth<&C::strainLimit>({.name = "strain_limit", .label = "Strain limit", .min = 0, .max = 1e3, .minExclusive = true,
      .typicalMin = 0.01, .typicalMax = 1, .engine = kFabric,
      .help = "Strain from which the yarns lock and the stress grows with the square of the rest; cotton 0.2."}),
    Cloth<&C::warpAngle>({.name = "warp_angle", .label = "Warp angle", .unit = "degree", .min = -360, .max = 360,
      .typicalMin = -90, .typicalMax = 90, .effect = kRebuild, .engine = kFabric,
      .help = "Of the warp, turned from the width towards the height; 45 is cut on the bias."}),
    Cloth<&C::pressure>({.name = "pressure", .label = "Pressure", .unit = "Pa", .min = -1e6, .max = 1e6,
      .typicalMin = 0, .typicalMax = 100, .engine = kFabric,
      .help = "Inside of a closed cloth above the outside; a soft cushion 10."}),
    Cloth<&C::contactDistance>({.name = "contact_distance", .label = "Contact distance", .unit = "m", .min = 0, .max = kFarthest,
      .typicalMin = 0, .typicalMax = 0.02, .engine = kFabric,
      .help = "Cloth pushes back what comes nearer: cloth, and colliders; 0: three tenths of its mean edge."}),
    Cloth<&C::friction>({.name = "friction", .label = "Friction", .min = 0, .max = 10,
      .typicalMin = 0, .typicalMax = 1, .engine = kFabric,
      .help = "Of cloth on cloth, force along over force across (Coulomb); between two cloths their mean."}),
    Cloth<&C::membraneLaw>({.name = "membrane_law", .label = "Membrane", .engine = kFabric,
      .help = "st_venant_kirchhoff: warp and weft differ; neo_hookean: one stiffness, for rubber."}),
    Cloth<&C::bendingLaw>({.name = "bending_law", .label = "Bending law", .effect = kRebuild, .engine = kFabric,
      .help = "quadratic: flat at rest; hinges: by angles, for any rest shape and for folds that stay."}),
    Cloth<&C::restAngles>({.name = "rest_angles", .label = "Rest angles", .engine = kFabric,
      .help = "What bending_law hinges bends back to: flat, or the shape in which the cloth starts."}),
    Cloth<&C::color>({.name = "color", .label = "Colour", .min = 0, .max = 1,
      .typicalMin = 0, .typicalMax = 1, .help = "Of this cloth: red, green, blue, times the base colour of the look."}),
    Cloth<&C::backColor>({.name = "back_color", .label = "Colour of the back", .min = 0, .max = 1,
      .typicalMin = 0, .typicalMax = 1, .help = "The same for its back, with shaders that tell the sides apart."}),

    Sphere<&SphereSettings::origin>({.name = "origin", .label = "Centre", .unit = "m", .min = -kFarthest,
      .max = kFarthest, .required = true,
      .typicalMin = -2, .typicalMax = 2, .help = "Centre of the sphere."}),
    Sphere<&SphereSettings::radius>({.name = "radius", .label = "Radius", .unit = "m", .min = 0, .max = kFarthest,
      .minExclusive = true, .required = true,
      .typicalMin = 0.01, .typicalMax = 1, .help = "Radius of the sphere."}),
    Sphere<&SphereSettings::friction>({.name = "friction", .label = "Friction", .min = 0, .max = 1, .required = true,
      .typicalMin = 0, .typicalMax = 1, .help = "0: cloth slides off; 1: it stays where it touched. With engine fabric: Coulomb's coefficient."}),

    Plane<&PlaneSettings::point>({.name = "point", .label = "Point", .unit = "m", .min = -kFarthest, .max = kFarthest,
      .required = true,
      .typicalMin = -2, .typicalMax = 2, .help = "Any point of the plane; the square that is drawn is centred here."}),
    Plane<&PlaneSettings::normal>({.name = "normal", .label = "Normal", .min = -kFarthest, .max = kFarthest,
      .required = true,
      .typicalMin = -1, .typicalMax = 1, .help = "Direction across the plane, of any length but 0."}),
    Plane<&PlaneSettings::friction>({.name = "friction", .label = "Friction", .min = 0, .max = 1, .required = true,
      .typicalMin = 0, .typicalMax = 1, .help = "0: cloth slides; 1: it stays where it touched. With engine fabric: Coulomb's coefficient."}),

    Collider<&O::shape>({.name = "shape", .label = "Shape", .effect = kRebuild,
      .help = "Of `radius`: sphere, capsule, cylinder, cone, torus; box of `size`; an endless plane, up its y; mesh from the file `mesh`."}),
    Collider<&O::position>({.name = "position", .label = "Position", .unit = "m", .min = -kFarthest, .max = kFarthest,
      .typicalMin = -2, .typicalMax = 2,
      .help = "Of its centre; any point of a plane; of a mesh the origin of its file."}),
    Collider<&O::rotation>({.name = "rotation", .label = "Rotation", .unit = "degree", .min = -360, .max = 360,
      .typicalMin = -180, .typicalMax = 180, .help = "Turns it about x, then y, then z, around its position."}),
    Collider<&O::size>({.name = "size", .label = "Size", .unit = "m", .min = 0, .max = kFarthest, .minExclusive = true,
      .typicalMin = 0.01, .typicalMax = 2, .help = "Edges of a box along x, y, z before it is turned."}),
    Collider<&O::radius>({.name = "radius", .label = "Radius", .unit = "m", .min = 0, .max = kFarthest,
      .minExclusive = true, .typicalMin = 0.01, .typicalMax = 1,
      .help = "Of a sphere, a capsule, a cylinder, a cone's base, and of the ring of a torus to the middle of its tube."}),
    Collider<&O::length>({.name = "length", .label = "Length", .unit = "m", .min = 0, .max = kFarthest,
      .minExclusive = true, .typicalMin = 0.01, .typicalMax = 2,
      .help = "Of a cylinder or cone along its y, of a capsule between the centres of its caps."}),
    Collider<&O::tubeRadius>({.name = "tube_radius", .label = "Tube's radius", .unit = "m", .min = 0, .max = kFarthest,
      .minExclusive = true, .typicalMin = 0.01, .typicalMax = 0.5,
      .help = "Of the tube of a torus, less than its radius; the ring lies around its y."}),
    Collider<&O::mesh>({.name = "mesh", .label = "Mesh", .effect = kRebuild,
      .help = "File of a mesh, .obj or .ply; the path begins at the folder of the scene's file."}),
    Collider<&O::meshScale>({.name = "mesh_scale", .label = "Mesh scale", .unit = "m", .min = 0, .max = 1e6,
      .minExclusive = true, .typicalMin = 0.001, .typicalMax = 10, .logarithmic = true, .effect = kRebuild,
      .help = "Length of one unit of the mesh's file; 0.01 where it is in centimetres."}),
    Collider<&O::cache>({.name = "cache", .label = "Vertex cache", .effect = kRebuild,
      .help = "File of samples by which the mesh's vertices move, .pc2 or .mdd, one point per vertex of the mesh's file."}),
    Collider<&O::cacheRate>({.name = "cache_rate", .label = "Samples/s", .unit = "1/s", .min = 0, .max = kMostSteps,
      .typicalMin = 0, .typicalMax = 120,
      .help = "Samples of the cache per second; 0: as its file states, of a .pc2 below 0.2 in seconds, else in frames of the scene."}),
    Collider<&O::cacheStart>({.name = "cache_start", .label = "Cache's start", .unit = "s", .min = -kLatest,
      .max = kLatest, .typicalMin = 0, .typicalMax = 10,
      .help = "When the first sample is due; before it, and after the last, the vertices rest."}),
    Collider<&O::twoSided>({.name = "two_sided", .label = "Two-sided",
      .help = "Of an open mesh: cloth stays on the side where it is; false: in front, from where the triangles run counter-clockwise."}),
    Collider<&O::friction>({.name = "friction", .label = "Friction", .min = 0, .max = 10,
      .typicalMin = 0, .typicalMax = 1, .help = "Coulomb's coefficient: ice 0.02, wood 0.3, rubber 1."}),
    Collider<&O::thickness>({.name = "thickness", .label = "Thickness", .unit = "m", .min = 0, .max = kFarthest,
      .typicalMin = 0, .typicalMax = 0.02, .help = "Cloth keeps so much farther off."}),
    Collider<&O::color>({.name = "color", .label = "Colour", .min = 0, .max = 1,
      .typicalMin = 0, .typicalMax = 1, .effect = Effect::View,
      .help = "Red, green, blue, times the base colour of the look."}),

    PatchOf<&Patch::cloth>({.name = "cloth", .label = "Cloth", .min = 0, .max = kMostPoints,
      .help = "Which cloth, counted from 0."}),
    PatchOf<&Patch::group>({.name = "group", .label = "Group",
      .help = "Group of the mesh's vertices; its triangles are those with all corners in it."}),
    PatchOf<&Patch::rectangle>({.name = "rectangle", .label = "Rectangle",
      .help = "Part of a grid, [[i0, j0], [i1, j1]], with both corners; none: all of the cloth."}),
    PatchOf<&Patch::stretch>({.name = "stretch", .label = "Stretch", .min = 0, .max = 1e6, .minExclusive = true,
      .typicalMin = 0.01, .typicalMax = 100, .logarithmic = true,
      .help = "Times the stiffness against stretch and shear."}),
    PatchOf<&Patch::bend>({.name = "bend", .label = "Bend", .min = 0, .max = 1e6,
      .typicalMin = 0.01, .typicalMax = 100, .logarithmic = true,
      .help = "Times the stiffness against bending."}),
    PatchOf<&Patch::density>({.name = "density", .label = "Density", .min = 0, .max = 1e6, .minExclusive = true,
      .typicalMin = 0.1, .typicalMax = 10, .logarithmic = true,
      .help = "Times the density."}),

    TetherOf<&Tether::cloth>({.name = "cloth", .label = "Cloth", .min = 0, .max = kMostPoints,
      .help = "Which cloth, counted from 0."}),
    TetherOf<&Tether::points>({.name = "points", .label = "Points", .required = true,
      .help = "Points on a rope each, as [i, j] or a vertex."}),
    TetherOf<&Tether::anchor>({.name = "anchor", .label = "Anchor", .unit = "m", .min = -kFarthest, .max = kFarthest,
      .required = true,
      .typicalMin = -2, .typicalMax = 2, .help = "Where the ropes are tied."}),
    TetherOf<&Tether::length>({.name = "length", .label = "Length", .unit = "m", .min = 0, .max = kFarthest,
      .required = true,
      .typicalMin = 0, .typicalMax = 2, .help = "Up to which a rope is slack."}),
    TetherOf<&Tether::stiffness>({.name = "stiffness", .label = "Stiffness", .unit = "N/m", .min = 0, .max = 1e9,
      .minExclusive = true,
      .typicalMin = 10, .typicalMax = 1e6, .logarithmic = true, .help = "Force per way beyond the length."}),

    Motion<&PinMotion::cloth>({.name = "cloth", .label = "Cloth", .min = 0, .max = kMostPoints,
      .help = "Which cloth, counted from 0."}),
    Motion<&PinMotion::points>({.name = "points", .label = "Points",
      .help = "Pinned points that move, each as [i, j] or a vertex; none: all pins of the cloth."}),
    Motion<&PinMotion::start>({.name = "start", .label = "Start", .unit = "s", .min = 0, .max = kLatest,
      .typicalMin = 0, .typicalMax = 10, .help = "When the motion begins."}),
    Motion<&PinMotion::end>({.name = "end", .label = "End", .unit = "s", .min = 0, .max = kLatest,
      .minExclusive = true, .required = true,
      .typicalMin = 0, .typicalMax = 10, .help = "When the motion is over, later than its start."}),
    Motion<&PinMotion::displacement>({.name = "displacement", .label = "Displacement", .unit = "m", .min = -kFarthest,
      .max = kFarthest,
      .typicalMin = -2, .typicalMax = 2,
      .help = "How far the points are carried in all; several motions of a point add up."}),
    Motion<&PinMotion::axis>({.name = "axis", .label = "Axis", .min = -kFarthest, .max = kFarthest,
      .typicalMin = -1, .typicalMax = 1, .help = "Direction about which the points are turned, of any length but 0."}),
    Motion<&PinMotion::angle>({.name = "angle", .label = "Angle", .unit = "degree", .min = -kMostDegrees,
      .max = kMostDegrees, .typicalMin = -720, .typicalMax = 720,
      .help = "By which the points are turned in all, counter-clockwise seen from the axis' tip; 720 is two turns."}),
    Motion<&PinMotion::centre>({.name = "centre", .label = "Centre", .unit = "m", .min = -kFarthest, .max = kFarthest,
      .typicalMin = -2, .typicalMax = 2, .help = "A point of the axis; displacements carry it along."}),
    Motion<&PinMotion::steady>({.name = "steady", .label = "Steady",
      .help = "At constant speed from start to end, not smoothly from rest to rest."}),

    Turn<&M::collider>({.name = "collider", .label = "Collider", .min = 0, .max = kMostPoints,
      .help = "Which collider, counted from 0."}),
    Turn<&M::start>({.name = "start", .label = "Start", .unit = "s", .min = 0, .max = kLatest,
      .typicalMin = 0, .typicalMax = 10, .help = "When the motion begins."}),
    Turn<&M::end>({.name = "end", .label = "End", .unit = "s", .min = 0, .max = kLatest,
      .minExclusive = true, .required = true,
      .typicalMin = 0, .typicalMax = 10, .help = "When the motion is over, later than its start."}),
    Turn<&M::displacement>({.name = "displacement", .label = "Displacement", .unit = "m", .min = -kFarthest,
      .max = kFarthest, .typicalMin = -2, .typicalMax = 2,
      .help = "How far it is carried in all; several motions of a collider add up."}),
    Turn<&M::axis>({.name = "axis", .label = "Axis", .min = -kFarthest, .max = kFarthest,
      .typicalMin = -1, .typicalMax = 1, .help = "Direction about which it is turned, of any length but 0."}),
    Turn<&M::angle>({.name = "angle", .label = "Angle", .unit = "degree", .min = -kMostDegrees,
      .max = kMostDegrees, .typicalMin = -720, .typicalMax = 720,
      .help = "By which it is turned in all, counter-clockwise seen from the axis' tip; 720 is two turns."}),
    WithChoice(Turn<&M::centre>({.name = "centre", .label = "Centre", .unit = "m", .min = -kFarthest,
      .max = kFarthest, .typicalMin = -2, .typicalMax = 2, .help = "A point of the axis; displacements carry it along."}),
      &ChooseCentre),
    Turn<&M::ownCentre>({.name = "own_centre", .label = "Own centre",
      .help = "The axis runs through the collider's position; false as soon as `centre` is stated."}),
    Turn<&M::steady>({.name = "steady", .label = "Steady",
      .help = "At constant speed from start to end, not smoothly from rest to rest."}),
    Turn<&M::jump>({.name = "jump", .label = "Jump",
      .help = "All of it at once at `end`, with no way between: cloth that is there is pulled out; false: swept along."}),

    Wind<&WindSettings::velocity>({.name = "velocity", .label = "Velocity", .unit = "m/s", .min = -1e4, .max = 1e4,
      .typicalMin = -20, .typicalMax = 20, .help = "Of the air; a breeze is 5, a storm 25."}),
    Wind<&WindSettings::drag>({.name = "drag", .label = "Drag", .unit = "kg/(m^2 s)", .min = 0, .max = 1e6,
      .typicalMin = 0, .typicalMax = 1000,
      .engine = kSprings, .help = "Force per area and speed across the cloth; 0: the air resists nothing."}),
    Wind<&WindSettings::gustiness>({.name = "gustiness", .label = "Gustiness", .min = 0, .max = 1,
      .typicalMin = 0, .typicalMax = 1, .help = "Share of itself by which the wind's speed swings."}),
    Wind<&WindSettings::gustPeriod>({.name = "gust_period", .label = "Gust period", .unit = "s", .min = 0,
      .max = kLatest, .minExclusive = true,
      .typicalMin = 0.1, .typicalMax = 10, .help = "Time from gust to gust."}),
    Wind<&WindSettings::airDensity>({.name = "air_density", .label = "Air density", .unit = "kg/m^3", .min = 0,
      .max = 1e5, .typicalMin = 0, .typicalMax = 2, .engine = kFabric, .help = "1.2 at sea level; 0: no air."}),
    Wind<&WindSettings::dragCoefficient>({.name = "drag_coefficient", .label = "Drag coefficient", .min = 0, .max = 1e3,
      .typicalMin = 0, .typicalMax = 3, .engine = kFabric, .help = "Of a sheet across the wind; a plate has 1.2."}),
    Wind<&WindSettings::liftCoefficient>({.name = "lift_coefficient", .label = "Lift coefficient", .min = 0, .max = 1e3,
      .typicalMin = 0, .typicalMax = 3, .engine = kFabric, .help = "Of a sheet aslant to the wind, beyond what a flat plate has by its drag."}),

    WithChoice(Simulation<&S::engine>({.name = "engine", .label = "Engine", .effect = kRebuild,
      .help = "springs: the classic simulator; fabric: a continuum of measured stiffness. Sets its usual steps."}),
      &ChooseEngine),
    Simulation<&S::framesPerSecond>({.name = "frames_per_second", .label = "Frames/s", .unit = "1/s", .min = 1,
      .max = kMostSteps,
      .typicalMin = 10, .typicalMax = 240, .help = "Pictures per simulated second."}),
    Simulation<&S::stepsPerFrame>({.name = "steps_per_frame", .label = "Steps/frame", .min = 1, .max = kMostSteps,
      .typicalMin = 1, .typicalMax = 100,
      .help = "Time steps from picture to picture; stiffer or lighter cloth needs more."}),
    Simulation<&S::gravity>({.name = "gravity", .label = "Gravity", .unit = "m/s^2", .min = -kFarthest,
      .max = kFarthest,
      .typicalMin = -20, .typicalMax = 20, .help = "Acceleration of everything that has mass; (0, -9.8, 0) on Earth."}),
    Simulation<&S::selfCollision>({.name = "self_collision", .label = "Self-collision",
      .help = "Points of cloth keep apart, within a cloth and between cloths."}),
    Simulation<&S::hash>({.name = "hash", .label = "Hash function",
      .engine = kSprings, .help = "How the map of boxes is kept: exact; the write-up's linear and powers, which share boxes; brute force."}),
    Simulation<&S::planeResponse>({.name = "plane_response", .label = "Plane response",
      .engine = kSprings, .help = "Where a point that crossed is put: interpolate: where it crossed; offset: above its foot; hold: back."}),

    Simulation<&S::newtonIterations>({.name = "newton_iterations", .label = "Newton iterations", .min = 1, .max = 1000,
      .typicalMin = 1, .typicalMax = 20, .engine = kFabric,
      .help = "At most so many corrections of a step; 3 keep up with real time."}),
    Simulation<&S::linearIterations>({.name = "linear_iterations", .label = "Linear iterations", .min = 1, .max = 10000,
      .typicalMin = 1, .typicalMax = 50, .engine = kFabric,
      .help = "At most so many iterations of the linear solver for each correction; where one gained what was foretold, the next may make all that are left."}),
    Simulation<&S::tolerance>({.name = "tolerance", .label = "Tolerance", .min = 0, .max = 1, .minExclusive = true,
      .typicalMin = 1e-6, .typicalMax = 0.1, .logarithmic = true, .engine = kFabric,
      .help = "A step has converged when the next correction would be this share of the first."}),

    Camera<&CameraSettings::automatic>({.name = "automatic", .label = "Automatic",
      .help = "Look at the cloths as the course does; false as soon as another key of the camera is stated."}),
    Camera<&CameraSettings::target>({.name = "target", .label = "Target", .unit = "m", .min = -kFarthest,
      .max = kFarthest,
      .typicalMin = -2, .typicalMax = 2, .help = "The point looked at."}),
    Camera<&CameraSettings::distance>({.name = "distance", .label = "Distance", .unit = "m", .min = 0,
      .max = kFarthest, .minExclusive = true,
      .typicalMin = 0.1, .typicalMax = 10, .help = "From the target."}),
    Camera<&CameraSettings::azimuth>({.name = "azimuth", .label = "Azimuth", .unit = "degree", .min = -360, .max = 360,
      .typicalMin = -180, .typicalMax = 180, .help = "Turn about the vertical; 0 looks along -z."}),
    Camera<&CameraSettings::elevation>({.name = "elevation", .label = "Elevation", .unit = "degree", .min = -89,
      .max = 89,
      .typicalMin = -89, .typicalMax = 89, .help = "Above the horizon."}),

    Look<&LookSettings::shader>({.name = "shader", .label = "Shader",
      .help = "Name of a file shaders/NAME.frag, such as Wireframe, Normal, Phong, Fabric, or your own."}),
    Look<&LookSettings::color>({.name = "color", .label = "Colour", .min = 0, .max = 1,
      .typicalMin = 0, .typicalMax = 1, .help = "Base colour of cloths and spheres: red, green, blue."}),
    Look<&LookSettings::normalScaling>({.name = "normal_scaling", .label = "Normal scale", .min = -1000, .max = 1000,
      .typicalMin = 0, .typicalMax = 20, .help = "Strength of the bumps of Bump and Displacement."}),
    Look<&LookSettings::heightScaling>({.name = "height_scaling", .label = "Height scale", .min = -1000, .max = 1000,
      .typicalMin = 0, .typicalMax = 1, .help = "How far Displacement moves the surface."}),
    Look<&LookSettings::tangents>({.name = "tangents", .label = "Tangents",
      .help = "constant: (1, 0, 0) on all of a cloth, as in the course; from_uv: along its width as it lies."}),
  };
}
// clang-format on

template <auto Owner>
std::size_t Count(const Scene& scene) {
  if constexpr (IsVector<std::remove_cvref_t<decltype(scene.*Owner)>>::value)
    return (scene.*Owner).size();
  else
    return 1;
}
template <auto Owner>
void Resize(Scene& scene, std::size_t count) {
  if constexpr (IsVector<std::remove_cvref_t<decltype(scene.*Owner)>>::value)
    (scene.*Owner).resize(count);
  else
    static_cast<void>(scene), static_cast<void>(count);
}
template <auto Owner>
constexpr ParameterGroup Group(std::string_view name, bool required, std::string_view help) {
  constexpr bool kIsArray = IsVector<std::remove_cvref_t<decltype(std::declval<Scene&>().*Owner)>>::value;
  return {name, kIsArray, required, help, &Count<Owner>, &Resize<Owner>};
}

constexpr ParameterGroup kGroups[] = {
    Group<&Scene::cloths>("cloth", true, "A sheet of cloth."),
    Group<&Scene::spheres>("sphere", false, "A ball that cloth rests on."),
    Group<&Scene::planes>("plane", false, "An endless flat wall or floor."),
    Group<&Scene::colliders>("collider", false, "Something solid of any shape, which cloth does not enter."),
    Group<&Scene::patches>("patch", false, "A part of a cloth whose material differs from the rest by factors."),
    Group<&Scene::tethers>("tether", false, "Ropes from points of a cloth to a place, slack up to their length."),
    Group<&Scene::pinMotions>("pin_motion", false, "Carries pinned points of a cloth, and turns them."),
    Group<&Scene::colliderMotions>("collider_motion", false, "Carries a collider, and turns it."),
    Group<&Scene::wind>("wind", false, "Moving air that pushes on the cloth."),
    Group<&Scene::simulation>("simulation", false, "How time is cut into steps, and which rules act."),
    Group<&Scene::camera>("camera", false, "Where the picture is taken from."),
    Group<&Scene::look>("look", false, "How cloths and colliders are drawn."),
};

const std::vector<Parameter>& Table() {
  static const std::vector<Parameter> table = MakeTable();
  return table;
}

/// "a number >= 0 N/m"; with `all`, every bound, however far.
std::string Expected(const Parameter& p, bool all) {
  const auto named = [&](double bound) { return std::isfinite(bound) && (all || std::abs(bound) <= kWorthNaming); };
  const auto range = [&] {
    const std::string unit = p.unit.empty() ? "" : " " + std::string(p.unit);
    if (named(p.min) && named(p.max)) {
      if (p.minExclusive) return " > " + FormatNumber(p.min) + " and <= " + FormatNumber(p.max) + unit;
      return " from " + FormatNumber(p.min) + " to " + FormatNumber(p.max) + unit;
    }
    if (named(p.min)) return (p.minExclusive ? " > " : " >= ") + FormatNumber(p.min) + unit;
    if (named(p.max)) return " <= " + FormatNumber(p.max) + unit;
    return p.unit.empty() ? "" : " in" + unit;
  };
  switch (p.kind) {
    case ValueKind::Number:
      return "a number" + range();
    case ValueKind::Integer: {
      if (p.choices.empty()) return "a whole number" + range();
      std::string out;
      for (std::size_t i = 0; i < p.choices.size(); ++i) {
        out += (i > 0 ? " or " : "") + std::to_string(i) + " (" + std::string(p.choices[i]) + ")";
      }
      return out;
    }
    case ValueKind::Boolean:
      return "true or false";
    case ValueKind::Choice: {
      if (p.choices.size() == 1) return Quote(p.choices[0]);
      std::string out = "one of";
      for (std::size_t i = 0; i < p.choices.size(); ++i) out += (i > 0 ? ", " : " ") + Quote(p.choices[i]);
      return out;
    }
    case ValueKind::Text:
      return "a text in double quotes";
    case ValueKind::Vector:
      return "an array of three numbers" + range();
    case ValueKind::GridPoints:
      break;
  }
  return "an array of points [i, j], or of vertices";
}

std::string Found(const Parameter& p, bool all, const Value& value) {
  return "expected " + Expected(p, all) + ", got " + FormatValue(value);
}

/// Whether `number` is within the bounds of `p`; false for NaN.
bool InRange(const Parameter& p, double number) {
  return (p.minExclusive ? number > p.min : number >= p.min) && number <= p.max && std::isfinite(number);
}

std::vector<std::string_view> GroupNames() {
  std::vector<std::string_view> names;
  for (const ParameterGroup& group : kGroups) names.push_back(group.name);
  return names;
}

std::vector<std::string_view> ParameterNames(std::string_view group) {
  std::vector<std::string_view> names;
  for (const Parameter& parameter : Table()) {
    if (parameter.group == group) names.push_back(parameter.name);
  }
  return names;
}

// Values of assignments: JSON, or a bare word for a text.

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

/// The elements of "[a, b, c]", at the outermost level; nothing if `text` is not in brackets.
std::optional<std::vector<std::string_view>> Elements(std::string_view text) {
  text = Trimmed(text);
  if (text.size() < 2 || text.front() != '[' || text.back() != ']') return std::nullopt;
  text = Trimmed(text.substr(1, text.size() - 2));
  std::vector<std::string_view> elements;
  if (text.empty()) return elements;
  int depth = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '[') ++depth;
    if (text[i] == ']' && --depth < 0) return std::nullopt;
    if (text[i] == ',' && depth == 0) {
      elements.push_back(Trimmed(text.substr(begin, i - begin)));
      begin = i + 1;
    }
  }
  if (depth != 0) return std::nullopt;
  elements.push_back(Trimmed(text.substr(begin)));
  return elements;
}

std::optional<std::vector<double>> Numbers(std::string_view text, std::size_t count) {
  const auto elements = Elements(text);
  if (!elements || elements->size() != count) return std::nullopt;
  std::vector<double> numbers;
  for (const std::string_view element : *elements) {
    const auto number = ParseTypedNumber(element);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

bool IsWholeInt(double number) {
  return std::trunc(number) == number && std::abs(number) <= kLargestInt;
}

/// The value that `text` states for `p`, or nothing if it is not of the parameter's kind.
std::optional<Value> ParseValue(const Parameter& p, std::string_view text) {
  text = Trimmed(text);
  switch (p.kind) {
    case ValueKind::Number:
    case ValueKind::Integer:
      if (const auto number = ParseTypedNumber(text)) return *number;
      return std::nullopt;
    case ValueKind::Boolean:
      if (text == "true" || text == "false") return text == "true";
      return std::nullopt;
    case ValueKind::Choice:
    case ValueKind::Text: {
      if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
      if (text.find_first_of("\"\\") != std::string_view::npos) return std::nullopt;
      return std::string(text);
    }
    case ValueKind::Vector:
      if (const auto v = Numbers(text, 3)) return Vec3{(*v)[0], (*v)[1], (*v)[2]};
      return std::nullopt;
    case ValueKind::GridPoints:
      break;
  }
  const auto elements = Elements(text);
  if (!elements) return std::nullopt;
  std::vector<GridPoint> points;
  for (const std::string_view element : *elements) {
    const auto vertex = ParseTypedNumber(element);
    const auto ij = vertex ? std::optional(std::vector{*vertex, 0.0}) : Numbers(element, 2);
    if (!ij || !IsWholeInt((*ij)[0]) || !IsWholeInt((*ij)[1])) return std::nullopt;
    points.push_back({static_cast<int>((*ij)[0]), static_cast<int>((*ij)[1])});
  }
  return points;
}

}  // namespace

std::span<const Parameter> Parameters() {
  return Table();
}
std::span<const ParameterGroup> ParameterGroups() {
  return kGroups;
}

const ParameterGroup* FindGroup(std::string_view name) {
  for (const ParameterGroup& group : kGroups) {
    if (group.name == name) return &group;
  }
  return nullptr;
}

const Parameter* FindParameter(std::string_view group, std::string_view name) {
  for (const Parameter& parameter : Table()) {
    if (parameter.group == group && parameter.name == name) return &parameter;
  }
  return nullptr;
}

std::vector<Difference> Differences(const Scene& a, const Scene& b) {
  std::vector<Difference> differences;
  for (const Parameter& parameter : Table()) {
    const ParameterGroup& group = *FindGroup(parameter.group);
    const std::size_t inA = group.count(a), inB = group.count(b);
    for (std::size_t i = 0; i < std::max(inA, inB); ++i) {
      const bool inBoth = i < std::min(inA, inB);
      if (!inBoth || parameter.get(a, i) != parameter.get(b, i)) differences.push_back({&parameter, i});
    }
  }
  return differences;
}

std::optional<Effect> EffectOf(const Scene& before, const Scene& after) {
  std::optional<Effect> greatest;
  if (before.planesFirst != after.planesFirst) greatest = Effect::Live;
  const auto compareMeshes = [&](const auto& a, const auto& b, auto mesh) {
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
      // The file may have changed.
      const bool both = a[i].shape == mesh && b[i].shape == mesh && a[i].loaded && b[i].loaded;
      if (both && a[i].loaded != b[i].loaded && *a[i].loaded != *b[i].loaded) greatest = Effect::Rebuild;
    }
  };
  compareMeshes(before.cloths, after.cloths, Shape::Mesh);
  compareMeshes(before.colliders, after.colliders, ColliderShape::Mesh);
  for (std::size_t i = 0; i < std::min(before.colliders.size(), after.colliders.size()); ++i) {
    const auto &a = before.colliders[i].loadedCache, &b = after.colliders[i].loadedCache;
    if (a && b && a != b && *a != *b) greatest = Effect::Rebuild;
  }
  for (const Difference& difference : Differences(before, after)) {
    greatest = std::max(greatest, std::optional(difference.parameter->effect));
  }
  return greatest;
}

Value DefaultValue(const Parameter& parameter) {
  static const Scene scene = [] {
    Scene s;
    for (const ParameterGroup& group : kGroups) group.resize(s, 1);
    return s;
  }();
  return parameter.get(scene, 0);
}

void Choose(const Parameter& parameter, Scene& scene, std::size_t index, const Value& value) {
  (parameter.choose ? parameter.choose : parameter.set)(scene, index, value);
}

bool IsHeeded(const Parameter& parameter, const Scene& scene) {
  return !parameter.engine || *parameter.engine == scene.simulation.engine;
}
bool IsRequired(const Parameter& parameter, const Scene& scene) {
  return parameter.required && (parameter.group != "cloth" || scene.simulation.engine == Engine::Springs);
}

std::optional<std::string> CheckValue(const Parameter& p, const Value& value) {
  const auto wrong = [&](bool all) { return std::optional(Found(p, all, value)); };
  switch (p.kind) {
    case ValueKind::Number:
    case ValueKind::Integer: {
      const double* number = std::get_if<double>(&value);
      if (!number) return wrong(false);
      if (p.kind == ValueKind::Integer && !(std::trunc(*number) == *number)) return wrong(false);
      if (!InRange(p, *number)) return wrong(*number > p.max);
      return std::nullopt;
    }
    case ValueKind::Boolean:
      return std::holds_alternative<bool>(value) ? std::nullopt : wrong(false);
    case ValueKind::Choice: {
      const std::string* text = std::get_if<std::string>(&value);
      if (!text) return wrong(false);
      if (std::find(p.choices.begin(), p.choices.end(), *text) != p.choices.end()) return std::nullopt;
      return Found(p, false, value) + DidYouMean(*text, p.choices);
    }
    case ValueKind::Text:
      return std::holds_alternative<std::string>(value) ? std::nullopt : wrong(false);
    case ValueKind::Vector: {
      const Vec3* v = std::get_if<Vec3>(&value);
      if (!v) return wrong(false);
      if (!InRange(p, v->x) || !InRange(p, v->y) || !InRange(p, v->z)) return wrong(true);
      return std::nullopt;
    }
    case ValueKind::GridPoints:
      break;
  }
  return std::holds_alternative<std::vector<GridPoint>>(value) ? std::nullopt : wrong(false);
}

std::string DescribeExpected(const Parameter& parameter) {
  return Expected(parameter, false);
}

std::string FormatValue(const Value& value) {
  struct Visitor {
    std::string operator()(double number) const { return FormatNumber(number); }
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(const std::string& text) const { return Quote(text); }
    std::string operator()(const Vec3& v) const {
      return "[" + FormatNumber(v.x) + ", " + FormatNumber(v.y) + ", " + FormatNumber(v.z) + "]";
    }
    std::string operator()(const std::vector<GridPoint>& points) const {
      std::string out = "[";
      for (const GridPoint& p : points) {
        out += (out.size() > 1 ? ", [" : "[") + std::to_string(p.i) + ", " + std::to_string(p.j) + "]";
      }
      return out + "]";
    }
  };
  return std::visit(Visitor{}, value);
}

Result<std::vector<std::string>> ApplyAssignment(Scene& scene, std::string_view assignment) {
  const auto fail = [&](const std::string& message) {
    return Result<std::vector<std::string>>(MakeError(Quote(assignment, 80) + ": " + message));
  };
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos) {
    return fail("expected GROUP.KEY=VALUE, such as cloth.ks=500; there is no '='");
  }
  const std::string_view path = Trimmed(assignment.substr(0, equals)), text = assignment.substr(equals + 1);
  const std::size_t firstDot = path.find('.'), lastDot = path.rfind('.');
  const std::string_view groupName = path.substr(0, firstDot);
  const std::string_view name = lastDot == std::string_view::npos ? std::string_view() : path.substr(lastDot + 1);

  const ParameterGroup* group = FindGroup(groupName);
  if (!group) {
    std::string owner;  // a bare key: tell whose it is
    for (const Parameter& p : Table()) {
      if (p.name == path && owner.empty())
        owner = " (did you mean " + std::string(p.group) + "." + std::string(p.name) + "?)";
    }
    const std::vector<std::string_view> known = GroupNames();
    std::string list;
    for (const std::string_view k : known) list += (list.empty() ? "" : ", ") + std::string(k);
    return fail("there is no group " + Quote(groupName, 40) + (owner.empty() ? DidYouMean(groupName, known) : owner) +
                "; the groups are " + list);
  }
  if (name.empty()) {
    return fail("expected GROUP.KEY=VALUE, such as " + std::string(groupName) + "." +
                std::string(ParameterNames(groupName).front()) + "=...");
  }
  const Parameter* parameter = FindParameter(groupName, name);
  if (!parameter) {
    const std::vector<std::string_view> known = ParameterNames(groupName);
    return fail(std::string(groupName) + " has no key " + Quote(name, 40) + DidYouMean(name, known));
  }

  const std::size_t count = group->count(scene);
  std::size_t begin = 0, end = count;
  if (lastDot != firstDot) {
    const std::string_view index = path.substr(firstDot + 1, lastDot - firstDot - 1);
    if (!group->isArray) return fail(std::string(groupName) + " is a single object and takes no index");
    const auto number = ParseNumber(index);
    if (!number || index.find_first_not_of("0123456789") != std::string_view::npos) {
      return fail("expected the index of a " + std::string(groupName) + ", such as " + std::string(groupName) + ".0." +
                  std::string(name) + ", got " + Quote(index, 40));
    }
    if (*number >= static_cast<double>(count)) {
      return fail("there is no " + std::string(groupName) + "." + std::string(index) + "; the scene has " +
                  std::to_string(count) + ", counted from 0");
    }
    begin = static_cast<std::size_t>(*number);
    end = begin + 1;
  } else if (count == 0) {
    return fail("the scene has no " + std::string(groupName) + " to set");
  }

  const std::optional<Value> value = ParseValue(*parameter, text);
  if (!value) return fail("expected " + Expected(*parameter, false) + ", got " + Quote(Trimmed(text), 40));
  if (const auto problem = CheckValue(*parameter, *value)) return fail(*problem);

  std::vector<std::string> paths;
  for (std::size_t i = begin; i < end; ++i) {
    Choose(*parameter, scene, i, *value);
    const std::string object = "/" + std::string(groupName) + (group->isArray ? "/" + std::to_string(i) : "");
    paths.push_back(object + "/" + std::string(name));
  }
  // As in a file: who places the camera by hand does not want it placed automatically.
  if (groupName == "camera" && name != "automatic") scene.camera.automatic = false;
  return paths;
}

}  // namespace percale
