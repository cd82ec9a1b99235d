#include "percale/checkpoint_file.h"

#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "io/atomic_file.h"
#include "mesh/cloth_model.h"
#include "percale/parameters.h"
#include "percale/scene_file.h"

namespace percale {
namespace {

// The file, little-endian: the mark; the version; the number of bytes that follow, but for the checksum;
// these bytes, as `Exchange` below lists them; their checksum.
constexpr std::string_view kMark = "Percale\x1a";
constexpr std::uint32_t kVersion = 3;
constexpr std::size_t kHeader = kMark.size() + sizeof(std::uint32_t) + sizeof(std::uint64_t);
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 36;

static_assert(std::endian::native == std::endian::little, "on another machine the numbers have to be turned round");

std::uint64_t Checksum(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

class Writer {
 public:
  template <class T>
  void Number(const T& number) {
    static_assert(std::is_arithmetic_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  void Text(const std::string& text) {
    Number(std::uint64_t{text.size()});
    bytes_ += text;
  }
  const std::string& bytes() const { return bytes_; }

  static constexpr bool kReads = false;

 private:
  std::string bytes_;
};

/// Reads zeros where the bytes are at their end, and remembers that.
class CheckpointReader {
 public:
  explicit CheckpointReader(std::string_view bytes) : rest_(bytes) {}
  template <class T>
  void Number(T& number) {
    number = {};
    if (!Has(sizeof number)) return;
    std::memcpy(&number, rest_.data(), sizeof number);
    rest_.remove_prefix(sizeof number);
  }
  void Text(std::string& text) {
    std::uint64_t size = 0;
    Number(size);
    if (!Has(size)) return;
    text = rest_.substr(0, size);
    rest_.remove_prefix(size);
  }
  /// Whether so many bytes are left.
  bool Has(std::uint64_t bytes) {
    good_ = good_ && bytes <= rest_.size();
    return good_;
  }
  bool AtEnd() const { return good_ && rest_.empty(); }

  static constexpr bool kReads = true;

 private:
  std::string_view rest_;
  bool good_ = true;
};

// One description for both directions: `Stream` is a Writer or a CheckpointReader.
template <class Stream, class V>
void Exchange(Stream& stream, V& v) requires std::is_same_v<std::remove_const_t<V>, Vec3> {
  stream.Number(v.x);
  stream.Number(v.y);
  stream.Number(v.z);
}
template <class Stream, class H>
void Exchange(Stream& stream, H& handle) requires std::is_same_v<std::remove_const_t<H>, Handle> {
  stream.Number(handle.cloth);
  stream.Number(handle.vertex);
  Exchange(stream, handle.target);
  stream.Number(handle.radius);
  stream.Number(handle.frequency);
}
template <class Stream, class B>
void Exchange(Stream& stream, B& ball) requires std::is_same_v<std::remove_const_t<B>, Ball> {
  Exchange(stream, ball.position);
  Exchange(stream, ball.velocity);
  stream.Number(ball.radius);
  stream.Number(ball.mass);
}
template <class Stream, class G>
void Exchange(Stream& stream, G& gust) requires std::is_same_v<std::remove_const_t<G>, Gust> {
  Exchange(stream, gust.velocity);
  stream.Number(gust.drag);
  stream.Number(gust.start);
  stream.Number(gust.duration);
}
template <class Stream, class F>
void Exchange(Stream& stream, F& fold) requires std::is_same_v<std::remove_const_t<F>, Fold> {
  stream.Number(fold.rest);
  stream.Number(fold.moved);
}
template <class Stream, class T>
void Exchange(Stream& stream, T& touch) requires std::is_same_v<std::remove_const_t<T>, Touch> {
  stream.Number(touch.kind);
  for (auto& number : touch.number) stream.Number(number);
  Exchange(stream, touch.hold);
  stream.Number(touch.force);
}
template <class Stream, class List>
void ExchangeList(Stream& stream, List& list) {
  std::uint64_t count = list.size();
  stream.Number(count);
  if constexpr (Stream::kReads) {
    // So that no count makes a list larger than the file by much; the file has no padding, which an item may.
    constexpr std::uint64_t kLeast = sizeof(typename List::value_type) / 2;
    if (!stream.Has(count <= kMostBytes ? count * kLeast : count)) return;
    list.resize(count);
  }
  for (auto& item : list) Exchange(stream, item);
}
template <class Stream, class Report>
void ExchangeReport(Stream& stream, Report& report) {
  stream.Number(report.frame);
  stream.Number(report.step);
  stream.Number(report.time);
  stream.Number(report.kineticEnergy);
  stream.Number(report.greatestStretch);
  stream.Number(report.greatestMove);
  stream.Number(report.selfContacts);
  stream.Number(report.colliderContacts);
  stream.Number(report.limitedSprings);
  std::uint8_t atRest = report.atRest;
  stream.Number(atRest);
  if constexpr (Stream::kReads) report.atRest = atRest != 0;
}
template <class Stream, class State>
void ExchangeState(Stream& stream, State& state) {
  ExchangeReport(stream, state.report);
  stream.Number(state.restFrames);
  if constexpr (Stream::kReads) state.cloths.resize(state.scene->cloths.size());
  for (auto& cloth : state.cloths) {
    ExchangeList(stream, cloth.positions);
    ExchangeList(stream, cloth.previous);
    ExchangeList(stream, cloth.anchors);
    ExchangeList(stream, cloth.folds);
  }
  ExchangeList(stream, state.touches);
  ExchangeList(stream, state.obstacles);
  ExchangeList(stream, state.handles);
  ExchangeList(stream, state.balls);
  ExchangeList(stream, state.gusts);
}

bool AllFinite(const std::vector<Vec3>& points) {
  for (const Vec3& p : points) {
    if (!IsFinite(p)) return false;
  }
  return true;
}

/// What no World can be in, or nothing.
std::string Impossible(const WorldState& state) {
  const StepReport& report = state.report;
  if (report.frame < 0 || report.step < 0 || !std::isfinite(report.time) || report.time < 0 || state.restFrames < 0)
    return "its frame or time is below 0";
  std::vector<std::size_t> sizes;
  for (std::size_t c = 0; c < state.cloths.size(); ++c) {
    const ClothSettings& settings = state.scene->cloths[c];
    const WorldState::Cloth& cloth = state.cloths[c];
    const auto points = static_cast<std::size_t>(VertexCount(settings));
    const std::string name = "cloth " + std::to_string(c);
    if (cloth.positions.size() != points || cloth.previous.size() != points) {
      return name + " has " + std::to_string(cloth.positions.size()) + " points, and its " +
             (settings.shape == Shape::Grid ? "grid " : "mesh ") + std::to_string(points);
    }
    if (cloth.anchors.size() != PinnedVertices(settings).size()) return name + " has another number of pins";
    if (!AllFinite(cloth.positions) || !AllFinite(cloth.previous) || !AllFinite(cloth.anchors))
      return name + " has a position that is no number";
    for (const Fold& fold : cloth.folds) {
      if (!std::isfinite(fold.rest) || !std::isfinite(fold.moved) || fold.moved < 0)
        return name + " has a fold that is no number";
    }
    sizes.push_back(points);
  }
  for (const Touch& touch : state.touches) {
    if (touch.kind < 0 || touch.kind > 2 || !IsFinite(touch.hold) || !std::isfinite(touch.force) || touch.force < 0)
      return "a contact is none";
  }
  if (!AllFinite(state.obstacles)) return "a collider has a position that is no number";
  for (const Handle& handle : state.handles) {
    const auto cloth = static_cast<std::size_t>(handle.cloth);
    if (handle.cloth < 0 || cloth >= sizes.size() || handle.vertex < 0 ||
        static_cast<std::size_t>(handle.vertex) >= sizes[cloth])
      return "a handle holds a vertex that does not exist";
    if (const auto problem = Check(handle)) return "a handle's " + *problem;
  }
  if (state.balls.size() > kMostBalls) return "it has " + std::to_string(state.balls.size()) + " balls";
  for (const Ball& ball : state.balls) {
    if (const auto problem = Check(ball)) return "a ball's " + *problem;
  }
  for (const Gust& gust : state.gusts) {
    if (const auto problem = Check(gust)) return "a gust's " + *problem;
  }
  return {};
}

Result<std::string> ReadAll(const std::filesystem::path& file) {
  const std::string name = PathText(file);
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) return MakeError(name, "there is no such file");
  if (!std::filesystem::is_regular_file(status)) return MakeError(name, "expected a checkpoint, got no ordinary file");
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return MakeError(name, "cannot be read: " + error.message());
  if (size > kMostBytes) return MakeError(name, "expected a checkpoint, got a file of more than 64 GB");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(OpenFile(file, "rb"), &std::fclose);
  if (!stream) return MakeError(name, std::string("cannot be read: ") + std::strerror(errno));
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (std::fread(bytes.data(), 1, bytes.size(), stream.get()) != bytes.size())
    return MakeError(name, "cannot be read to its end");
  return bytes;
}

}  // namespace

std::string FormatCheckpoint(const WorldState& state) {
  return FormatCheckpoint(state, FormatScene(WithAbsolutePaths(*state.scene)));
}

std::string FormatCheckpoint(const WorldState& state, const std::string& sceneText) {
  Writer body;
  body.Text(sceneText);
  ExchangeState(body, state);
  Writer head, tail;
  head.Number(kVersion);
  head.Number(std::uint64_t{body.bytes().size()});
  tail.Number(Checksum(body.bytes()));
  return std::string(kMark) + head.bytes() + body.bytes() + tail.bytes();
}

Status SaveCheckpoint(const std::filesystem::path& file, const WorldState& state) {
  return WriteFile(file, FormatCheckpoint(state));
}

Result<WorldState> LoadCheckpoint(const std::filesystem::path& file) {
  const Result<std::string> bytes = ReadAll(file);
  if (!bytes) return bytes.diagnostics();
  return ParseCheckpoint(*bytes, PathText(file));
}

Result<WorldState> ParseCheckpoint(std::string_view all, const std::string& name) {
  if (all.substr(0, kMark.size()) != kMark) {
    return MakeError(name, all.empty() ? "expected a checkpoint of Percale, got an empty file"
                                       : "expected a checkpoint of Percale, got something else");
  }
  CheckpointReader head(all.substr(kMark.size(), kHeader - kMark.size()));
  std::uint32_t version = 0;
  std::uint64_t size = 0, checksum = 0;
  head.Number(version);
  head.Number(size);
  if (head.AtEnd() && version != kVersion) {
    return MakeError(name, "expected a checkpoint of version " + std::to_string(kVersion) + ", got version " +
                               std::to_string(version) + "; open it with the version of Percale that wrote it");
  }
  if (!head.AtEnd() || size > kMostBytes || all.size() < kHeader + size + sizeof checksum) {
    return MakeError(name, "the checkpoint is cut short: it has " + std::to_string(all.size()) + " bytes of " +
                               (head.AtEnd() && size <= kMostBytes ? std::to_string(kHeader + size + sizeof checksum)
                                                                   : std::string("more")));
  }
  const std::string_view body = all.substr(kHeader, size);
  CheckpointReader tail(all.substr(kHeader + size));
  tail.Number(checksum);
  if (!tail.AtEnd() || checksum != Checksum(body)) {
    return MakeError(name, "the checkpoint has been changed or damaged: its checksum does not fit");
  }
  CheckpointReader reader(body);
  std::string text;
  reader.Text(text);
  Result<Scene> scene = ParseScene(text, name + " (its scene)");
  if (!scene) return scene.diagnostics();
  WorldState state;
  state.scene = std::make_shared<const Scene>(std::move(*scene));
  ExchangeState(reader, state);
  if (!reader.AtEnd()) return MakeError(name, "expected the state of the scene that the checkpoint holds, got another");
  if (const std::string problem = Impossible(state); !problem.empty())
    return MakeError(name, "no simulation can be in the state of this checkpoint: " + problem);
  return state;
}

}  // namespace percale
