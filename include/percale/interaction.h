#pragma once
/// \file
/// What a hand or a program does to a running World, apart from its settings: hold the cloth, throw balls at it,
/// blow at it, pull at it with forces of its own.

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "percale/vec3.h"

namespace percale {

/// A soft grip on a cloth. The vertex is drawn to the target as by a critically damped spring, taken
/// implicitly, so that no grip is too strong for the time step; the cloth around it comes along, less
/// and less towards the radius. Pinned points stay.
struct Handle {
  int cloth = 0;
  int vertex = 0;
  Vec3 target{};          ///< Where the vertex is to be [m].
  double radius = 0.06;   ///< Of the patch that is held, measured over the cloth at rest [m], > 0.
  double frequency = 50;  ///< Of the spring, without damping [Hz], > 0: 50 carries a cloth of 1 m^2 stiffly.
  friend bool operator==(const Handle&, const Handle&) = default;
};

/// A ball that flies, falls, bounces off colliders, and gives the cloth the momentum that it
/// loses.
struct Ball {
  Vec3 position{};      ///< Of the centre [m].
  Vec3 velocity{};      ///< [m/s]
  double radius = 0.1;  ///< [m], > 0.
  double mass = 1;      ///< [kg], > 0.
  friend bool operator==(const Ball&, const Ball&) = default;
};

/// One cloth at the start of a step, for forces of the program's own.
struct ForceCall {
  int cloth = 0;
  double time = 0;                   ///< Since the start [s].
  std::span<const Vec3> positions;   ///< [m], one per vertex.
  std::span<const Vec3> velocities;  ///< [m/s], one per vertex.
  std::span<Vec3> forces;            ///< Where they go [N], one per vertex; zero before the call.
};
/// Is called for each cloth in each step, on the thread that calls World::Step; must not throw.
using ForceFunction = std::function<void(const ForceCall&)>;
/// The greatest length of a force [N]. One that is greater, or not a number, ends the simulation as a divergence that
/// names the vertex.
inline constexpr double kMostForce = 1e9;

/// A World keeps no more balls; the oldest makes room.
inline constexpr std::size_t kMostBalls = 16;

/// A breath of wind beside the scene's own: it rises and falls within its duration as sin^2.
struct Gust {
  Vec3 velocity{};      ///< Of the air, at most [m/s].
  double drag = 1;      ///< As in WindSettings [kg/(m^2 s)], > 0.
  double start = 0;     ///< [s]
  double duration = 1;  ///< [s], > 0.
  friend bool operator==(const Gust&, const Gust&) = default;
};

/// What is wrong with it ("radius: expected a number > 0 m, got -1"), or nothing. The numbers of a
/// handle's cloth and vertex are for the World to judge.
std::optional<std::string> Check(const Handle& handle);
std::optional<std::string> Check(const Ball& ball);
std::optional<std::string> Check(const Gust& gust);

}  // namespace percale
