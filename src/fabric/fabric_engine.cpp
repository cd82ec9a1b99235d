#include "fabric/fabric_engine.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <numbers>

#include "collide/ball.h"
#include "core/index.h"

namespace percale::fabric {
namespace {

/// Beyond that coordinates are lost [m]; as with the springs.
constexpr double kBound = 1e6;
/// Drag coefficient of a sheet along the wind (Hoerner 1965, "Fluid-dynamic drag", chapter 2).
constexpr double kSkinDrag = 0.01;
/// Where more than this share of all vertices had to stop on their way, or one this share of the distance of contact
/// from where it was to go, the step goes on with what stopped it known, for so many more iterations or half as many as
/// it had, whichever is more; so often because of the latter.
constexpr double kMostCut = 0.005, kMostStopped = 0.01;
constexpr int kMoreIterations = 2;
constexpr int kMostRounds = 4;
/// Where a vertex is stopped farther than the distance of contact from where it was to go even then, the step is done
/// over in so many parts, and each of them again, so many times at most.
constexpr int kParts = 4, kMostSplits = 2;
/// So it is where a triangle gets longer by this factor, over what it was or, if it was shorter, its rest length; and
/// then once more, since what is torn out in one go may jam for good.
constexpr double kMostStretching = 1.5;
constexpr int kMostStretchSplits = 3;

bool InBounds(const Vec3& x) {
  return std::abs(x.x) <= kBound && std::abs(x.y) <= kBound && std::abs(x.z) <= kBound;
}

/// What is of one cloth. `first`: where each cloth begins, and the end.
template <class T>
std::span<const T> PartOf(std::span<const T> all, std::span<const int> first, int cloth) {
  const int begin = first[Index(cloth)], end = first[Index(cloth) + 1];
  return all.subspan(Index(begin), Index(end - begin));
}

}  // namespace

FabricEngine::FabricEngine(const Scene& scene, FabricModel model, const Executor& executor)
    : executor_(executor),
      scene_(scene),
      model_(std::move(model)),
      solver_(model_, executor),
      window_(model_),
      contact_(std::make_unique<ContactStep>(scene, model_, executor, solver_.objective().scratch())) {
  solver_.objective().SetContacts(&contact_->contacts());
  const std::size_t count = Index(model_.vertexCount);
  free_.assign(count, 1);
  position_ = previous_ = next_ = begin_ = before_ = model_.start;
  SetUp();
}

void FabricEngine::Configure(const Scene& scene) {
  scene_ = scene;
  TakeMaterials(scene, model_);
  if (contact_->Fits(scene)) {
    contact_->Configure(scene);
  } else {
    contact_ = std::make_unique<ContactStep>(scene, model_, executor_, solver_.objective().scratch());
    contact_->Restart(scene, time_);
    solver_.objective().SetContacts(&contact_->contacts());
  }
  SetUp();
}

/// What follows from the scene beside the model.
void FabricEngine::SetUp() {
  h_ = scene_.TimeStep();
  UpdatePins();
  solver_.SetUp(h_, free_);
  StartFolds();
}

/// Folds that have not set follow the model, those that have stay.
void FabricEngine::StartFolds() {
  if (folds_.empty() && !model_.yield.empty()) folds_.resize(model_.hinges.size());
  for (std::size_t h = 0; h < folds_.size(); ++h) {
    if (folds_[h].moved == 0) folds_[h].rest = model_.hinges[h].restAngle;
  }
  solver_.objective().SetFolds(folds_);
}

/// What the step that has ended leaves in the folds.
void FabricEngine::YieldFolds() {
  if (model_.yield.empty()) return;
  ForRange(executor_, folds_.size(), [&](int h) {
    const std::int32_t* v = model_.hinges[Index(h)].vertex;
    const auto x = [&](int k) { return From<double>(position_[Index(v[k])]); };
    Fold& fold = folds_[Index(h)];
    const SetFold<double> set = YieldedRestAngle(HingeAngle(x(0), x(1), x(2), x(3)),
                                                 SetFold<double>{fold.rest, fold.moved}, model_.yield[Index(h)]);
    fold = {set.rest, set.moved};
  });
}

void FabricEngine::UpdatePins() {
  pins_.Update(scene_, std::span(model_.firstVertex).first(Index(model_.Cloths())), time_,
               [&](int v) { return position_[Index(v)]; });
  std::fill(free_.begin(), free_.end(), std::uint8_t{1});
  for (const Pin& pin : pins_.All()) free_[Index(pin.point)] = 0;
}

void FabricEngine::Reset() {
  position_ = previous_ = model_.start;
  inBounds_ = true;
  pins_.Reset([&](int v) { return model_.start[Index(v)]; });
  time_ = 0;
  contact_->Restart(scene_, time_);
  folds_.clear();
  StartFolds();
}

void FabricEngine::MoveColliders(double time) {
  time_ = time;
  pins_.MoveTo(time);
  counts_.jumps += contact_->MoveColliders(scene_, time);
}

bool FabricEngine::ApplyForces(double time, std::span<const Gust> gusts, std::span<const Handle> handles) {
  gusts_.assign(gusts.begin(), gusts.end());
  handles_.assign(handles.begin(), handles.end());
  given_.clear();
  HoldPins();
  pinFrom_.clear();
  pinTo_.clear();
  for (const Pin& pin : pins_.All()) {
    pinFrom_.push_back(position_[Index(pin.point)]);
    pinTo_.push_back(pin.target);
  }
  BeginLoads();
  Blow(time);
  Hold();
  inBounds_ = true;
  for (std::size_t v = 0; v < position_.size() && inBounds_; ++v) inBounds_ = InBounds(Predicted(v));
  return inBounds_;
}

/// Where inertia and weight alone would lead.
Vec3 FabricEngine::Predicted(std::size_t v) const {
  return position_[v] + (position_[v] - previous_[v]) + Fall();
}

/// The loads of the step are those that were given.
void FabricEngine::BeginLoads() {
  loads_.clear();
  if (given_.empty()) return;
  const std::span<VertexLoad> loads = Loads();
  for (std::size_t v = 0; v < given_.size(); ++v) loads[v].force = given_[v];
}

/// The loads of the step at hand, for more to be added.
std::span<VertexLoad> FabricEngine::Loads() {
  loads_.resize(position_.size());
  return loads_;
}

/// Drag and lift of the air on each triangle, a third of it on each corner, which resists by its own way.
void FabricEngine::Blow(double time) {
  const WindSettings& wind = scene_.wind;
  Vec3 air = wind.velocity * (1 + wind.gustiness * std::sin(2 * std::numbers::pi * time / wind.gustPeriod));
  bool gusty = false;
  for (const Gust& gust : gusts_) {
    const double phase = std::numbers::pi * (time - gust.start) / gust.duration;
    if (phase <= 0 || phase >= std::numbers::pi) continue;
    air += gust.velocity * (std::sin(phase) * std::sin(phase));
    gusty = true;
  }
  const double density = wind.airDensity > 0 || !gusty ? wind.airDensity : WindSettings().airDensity;
  if (density == 0) return;
  windLoads_.resize(std::min(model_.triangles.size(), Index(window_.live())));  // before the first wind there are none
  const Air<double> properties{density, wind.dragCoefficient, kSkinDrag, wind.liftCoefficient};
  const auto evaluate = [&](int begin, int end) {
    BestKernels().windLoads({.begin = begin,
                             .end = end,
                             .triangles = model_.triangles.data(),
                             .x = position_.data(),
                             .previous = previous_.data(),
                             .h = h_,
                             .air = properties,
                             .wind = air,
                             .outFirst = begin,
                             .load = windLoads_.data() + window_.Place(begin)});
  };
  const std::span<VertexLoad> loads = Loads();
  window_.ForRows(executor_, evaluate, [&](int begin, int end, const LiveTriangles& live) {
    for (int v = begin; v < end; ++v) {
      for (std::int32_t e = model_.corners.first[Index(v)]; e < model_.corners.first[Index(v) + 1]; ++e) {
        const VertexLoad& load = windLoads_[Index(live.Place(model_.corners.entry[Index(e)]) / 3)];
        loads[Index(v)].stiffness += load.stiffness;
        loads[Index(v)].force += load.force;
      }
    }
  });
}

void FabricEngine::AddForces(int cloth, std::span<const Vec3> forces) {
  const std::size_t first = Index(model_.firstVertex[Index(cloth)]);
  given_.resize(position_.size());
  const std::span<VertexLoad> loads = Loads().subspan(first);
  for (std::size_t v = 0; v < forces.size(); ++v) {
    given_[first + v] += forces[v];
    loads[v].force += forces[v];
  }
}

/// A handle that grips a pin moves it.
void FabricEngine::HoldPins() {
  for (const Handle& handle : handles_) {
    const int centre = model_.firstVertex[Index(handle.cloth)] + handle.vertex;
    if (const Pin* pin = pins_.Find(centre))
      pins_.Shift(Index(pin - pins_.All().data()), handle.target - position_[Index(centre)]);
  }
}

/// Springs from the vertices around a grip to where it draws them, critically damped.
void FabricEngine::Hold() {
  for (const Handle& handle : handles_) {
    const int first = model_.firstVertex[Index(handle.cloth)], end = model_.firstVertex[Index(handle.cloth) + 1];
    const int centre = first + handle.vertex;
    if (!free_[Index(centre)]) continue;
    const Vec3 way = handle.target - position_[Index(centre)];
    const std::span<VertexLoad> loads = Loads();
    const double w = 2 * std::numbers::pi * handle.frequency;
    for (int v = first; v < end; ++v) {
      const double share = GripShare(handle, model_.start[Index(v)] - model_.start[Index(centre)]);
      if (share == 0 || !free_[Index(v)]) continue;
      const double stiffness = model_.mass[Index(v)] * share * w * w;
      const double diagonal = stiffness + 2 * model_.mass[Index(v)] * share * w / h_;
      loads[Index(v)].stiffness += {.xx = diagonal, .yy = diagonal, .zz = diagonal};
      loads[Index(v)].force += way * stiffness;
    }
  }
}

void FabricEngine::Solve() {
  before_ = previous_;
  contact_->Begin(previous_, position_);
  // Inertia may lead into much strain: then the better start is where the cloth is.
  ForRange(executor_, position_.size(), [&](int v) {
    begin_[Index(v)] = next_[Index(v)] = position_[Index(v)];
    previous_[Index(v)] = position_[Index(v)] + (position_[Index(v)] - previous_[Index(v)]);
  });
  std::vector<Vec3>& ahead = previous_;
  for (std::size_t p = 0; p < pinTo_.size(); ++p) {
    const std::size_t v = Index(pins_.All()[p].point);
    next_[v] = ahead[v] = pinTo_[p];
  }
  contact_->FindPlanes(begin_, position_, ahead, free_, h_);
  Objective& objective = solver_.objective();
  objective.Begin({.h = h_, .start = begin_, .before = before_, .fall = Fall(), .loads = loads_, .free = free_});
  const double least = objective.Energy(next_);
  const double ofAhead = objective.Energy(ahead);
  if (ofAhead < least) {
    std::swap(ahead, next_);
    Minimise(scene_.simulation.newtonIterations, ofAhead);
  } else {
    if (model_.Cloths() > 1) ExchangeCloths(ahead, least);
    Minimise(scene_.simulation.newtonIterations, objective.Energy(next_));
  }
  previous_ = begin_;
}

/// Exchanges the cloths of next_, whose energy is `least`, with those of another start where that gains: each for
/// itself, so that none that flies freely is held by what happens to another.
void FabricEngine::ExchangeCloths(std::vector<Vec3>& other, double least) {
  for (int c = 0; c < model_.Cloths(); ++c) {
    const auto exchange = [&] {
      const int* const first = &model_.firstVertex[Index(c)];
      std::swap_ranges(next_.begin() + first[0], next_.begin() + first[1], other.begin() + first[0]);
    };
    exchange();
    const double energy = solver_.objective().Energy(next_);
    if (energy < least)
      least = energy;
    else
      exchange();
  }
}

/// Goes on from next_. `energy`: what the objective gave for it, when it was asked last.
void FabricEngine::Minimise(int iterations, double energy) {
  const SimulationSettings& settings = scene_.simulation;
  const NewtonResult result = solver_.Solve(
      next_, energy,
      {.maxIterations = iterations, .maxLinearIterations = settings.linearIterations, .tolerance = settings.tolerance});
  counts_.newtonIterations += result.iterations;
  counts_.linearIterations += result.linearIterations;
  counts_.residual = std::max(counts_.residual, result.residual);
  counts_.converged = counts_.converged && result.converged;
}

void FabricEngine::Move() {
  if (!TryMove(0)) SplitStep(0, 1, 1);
  counts_.intersections = contact_->tangled();
  counts_.squeezed = contact_->CountSqueezed(position_);
}

/// Ends the step, or a part of it that comes of so many splits, if not too much is stopped on its way, or it may not be
/// split any more. Else false, and all is as it began.
bool FabricEngine::TryMove(int depth) {
  const bool maySplit = depth < kMostSplits;
  previous_ = next_;
  const std::vector<Vec3>& ahead = previous_;
  SafeMoveReport report = contact_->Move(position_, next_, maySplit);
  const double wanted = report.wanted;
  const double mostCut = kMostCut * static_cast<double>(position_.size());
  for (int round = 1; round < kMostRounds; ++round) {
    const bool many = round == 1 && static_cast<double>(report.cut) > mostCut;
    if (!report.gaveUp && !many && report.worst <= kMostStopped * contact_->distance()) break;
    const bool firm = round > 1 && report.worst > contact_->distance();
    if (maySplit && (firm || report.gaveUp)) return Rewind();
    // What was met on the way has its plane now, and what would be met on the rest of it.
    position_ = next_;
    contact_->FindPlanes(begin_, position_, ahead, free_, h_, firm);
    for (std::size_t p = 0; p < pinTo_.size(); ++p) next_[Index(pins_.All()[p].point)] = pinTo_[p];
    Minimise(std::max(kMoreIterations, scene_.simulation.newtonIterations / 2), solver_.objective().Energy(next_));
    report = contact_->Move(position_, next_, maySplit && round + 1 < kMostRounds);
  }
  if (depth < kMostStretchSplits && StretchesSuddenly()) return Rewind();
  counts_.lostWay += report.lost;
  counts_.wantedWay += wanted;
  previous_ = begin_;
  std::swap(position_, next_);
  contact_->End(position_);
  for (const Contact& contact : contact_->contacts().all()) {
    if (!contact.active) continue;
    ++(contact.key.kind == ContactKey::Kind::Shape ? counts_.colliderContacts : counts_.selfContacts);
  }
  YieldFolds();
  return true;
}

/// Puts all where the step, or the part of it, begins. False.
bool FabricEngine::Rewind() {
  position_ = begin_;
  previous_ = before_;
  contact_->Rewind();
  return false;
}

/// Whether a triangle is much longer in next_ than as the step began.
bool FabricEngine::StretchesSuddenly() {
  constexpr double kSquare = kMostStretching * kMostStretching;
  if (!(solver_.objective().GreatestStretch(next_).square > kSquare)) return false;
  std::atomic<bool> suddenly = false;
  ForRange(executor_, model_.triangles.size(), [&](int t) {
    const auto square = [&](std::span<const Vec3> y) {
      const Triangle& triangle = model_.triangles[Index(t)];
      const auto x = [&](std::int32_t v) { return From<double>(y[Index(v)]); };
      return SquaredStretch(Deformation(model_.Rest(Index(t)), x(triangle.a), x(triangle.b), x(triangle.c)));
    };
    const double now = square(next_);
    if (now > kSquare && now > kSquare * square(begin_)) suddenly = true;
  });
  return suddenly;
}

/// Does what lies between two shares of the whole step in parts: each as long a step of its own, or split again.
void FabricEngine::SplitStep(double from, double to, int depth) {
  ++counts_.splits;
  const auto setLength = [&](double h) {
    for (std::size_t v = 0; v < position_.size(); ++v)
      previous_[v] = position_[v] - (position_[v] - previous_[v]) * (h / h_);
    h_ = h;
    solver_.SetStep(h);
  };
  setLength(h_ / kParts);
  for (int part = 0; part < kParts; ++part) {
    const double begin = from + (to - from) * part / kParts;
    const double end = part + 1 < kParts ? from + (to - from) * (part + 1) / kParts : to;
    const double time = time_ - scene_.TimeStep() * (1 - end);
    for (std::size_t p = 0; p < pinTo_.size(); ++p)
      pinTo_[p] = pinFrom_[p] + (pins_.All()[p].target - pinFrom_[p]) * end;
    contact_->MoveColliders(scene_, time);
    BeginLoads();
    Blow(time);
    Hold();
    Solve();
    if (!TryMove(depth)) SplitStep(begin, end, depth + 1);
  }
  setLength(h_ * kParts);
}

void FabricEngine::CollideBall(Ball& ball) {
  struct Points {
    FabricEngine& e;
    int count() const { return e.model_.vertexCount; }
    bool fixed(int v) const { return !e.free_[Index(v)]; }
    double mass(int v) const { return e.model_.mass[Index(v)]; }
    const Vec3& at(int v) const { return e.position_[Index(v)]; }
    void put(int v, const Vec3& x) { e.next_[Index(v)] = x; }
  };
  next_ = position_;
  const std::int64_t contacts = PushApart(ball, h_, Points{*this}, touched_);
  counts_.colliderContacts += contacts;
  if (contacts == 0) return;
  contact_->MoveAside(position_, next_);
  std::swap(position_, next_);
}

void FabricEngine::Place(const Handle& handle) {
  const int first = model_.firstVertex[Index(handle.cloth)], end = model_.firstVertex[Index(handle.cloth) + 1];
  const int centre = first + handle.vertex;
  const Vec3 way = handle.target - position_[Index(centre)];
  next_ = position_;
  if (const Pin* pin = pins_.Find(centre)) {
    pins_.Shift(Index(pin - pins_.All().data()), way);
    next_[Index(centre)] += way;
  } else {
    for (int v = first; v < end; ++v) {
      const double share = GripShare(handle, model_.start[Index(v)] - model_.start[Index(centre)]);
      if (share > 0 && free_[Index(v)]) next_[Index(v)] += way * share;
    }
  }
  contact_->MoveAside(position_, next_);
  for (std::size_t v = 0; v < next_.size(); ++v) previous_[v] += next_[v] - position_[v];
  std::swap(position_, next_);
}

EngineCounts FabricEngine::TakeCounts() {
  counts_.contactBytes = static_cast<std::int64_t>(contact_->MemoryBytes());
  return std::exchange(counts_, {});
}

void FabricEngine::ReadState(int cloth, std::span<Vec3> positions, std::span<Vec3> previous) const {
  const auto first = static_cast<std::ptrdiff_t>(model_.firstVertex[Index(cloth)]);
  std::copy_n(position_.begin() + first, positions.size(), positions.begin());
  std::copy_n(previous_.begin() + first, previous.size(), previous.begin());
}

void FabricEngine::ReadAnchors(int cloth, std::vector<Vec3>& anchors) const {
  pins_.ReadAnchors(Index(cloth), anchors);
}

void FabricEngine::WriteState(int cloth, std::span<const Vec3> positions, std::span<const Vec3> previous,
                              std::span<const Vec3> anchors, double time) {
  const auto first = static_cast<std::ptrdiff_t>(model_.firstVertex[Index(cloth)]);
  std::copy(positions.begin(), positions.end(), position_.begin() + first);
  std::copy(previous.begin(), previous.end(), previous_.begin() + first);
  inBounds_ = true;
  pins_.WriteAnchors(Index(cloth), anchors, time, [&](int v) { return position_[Index(v)]; });
  time_ = time;
  contact_->Restart(scene_, time_);
}

void FabricEngine::ReadFolds(int cloth, std::vector<Fold>& folds) const {
  folds.clear();
  if (folds_.empty()) return;
  const int* const first = &model_.firstHinge[Index(cloth)];
  folds.assign(folds_.begin() + first[0], folds_.begin() + first[1]);
}

void FabricEngine::WriteFolds(int cloth, std::span<const Fold> folds) {
  const int* const first = &model_.firstHinge[Index(cloth)];
  const bool given = folds.size() == Index(first[1] - first[0]);
  if (given && folds_.empty()) folds_.resize(model_.hinges.size());
  if (folds_.empty()) return;
  if (given)
    std::copy(folds.begin(), folds.end(), folds_.begin() + first[0]);
  else
    std::fill(folds_.begin() + first[0], folds_.begin() + first[1], Fold{});
  StartFolds();
}

VertexRef FabricEngine::RefOf(int vertex) const {
  const auto cloth = std::upper_bound(model_.firstVertex.begin(), model_.firstVertex.end(), vertex) - 1;
  return {static_cast<int>(cloth - model_.firstVertex.begin()), vertex - *cloth};
}

/// The square of the larger singular value of a triangle's deformation gradient.
Stretch FabricEngine::GreatestStretch() {
  const MembraneStretch greatest = solver_.objective().GreatestStretch(position_);
  if (greatest.triangle < 0) return {};
  return {std::sqrt(greatest.square), RefOf(model_.triangles[Index(greatest.triangle)].a)};
}

double FabricEngine::ElasticEnergy() {
  return solver_.objective().ElasticEnergy(position_);
}

std::span<const double> FabricEngine::Masses(int cloth) const {
  return PartOf<double>(model_.mass, model_.firstVertex, cloth);
}

std::span<const Vec3> FabricEngine::Start(int cloth) const {
  return PartOf<Vec3>(model_.start, model_.firstVertex, cloth);
}

std::span<const Triangle> FabricEngine::Triangles(int cloth) const {
  return PartOf<Triangle>(model_.triangles, model_.firstTriangle, cloth);
}

VertexRef FabricEngine::FindOutOfBounds() const {
  for (int v = 0; v < model_.vertexCount; ++v) {
    if (!InBounds(position_[Index(v)]) || (!inBounds_ && !InBounds(Predicted(Index(v))))) return RefOf(v);
  }
  return {};
}

}  // namespace percale::fabric
