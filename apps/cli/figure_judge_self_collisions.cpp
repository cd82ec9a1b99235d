#include <algorithm>
#include <cmath>
#include <iterator>

#include "apps/cli/figure_judges.h"
#include "apps/cli/figure_studies.h"
#include "core/text.h"

namespace percale::cli {
namespace {

// In the order of kHashStudies.
constexpr std::size_t kExact = 0, kLinear = 1, kPowers = 2, kBrute = 3;
constexpr const char* kHashNames[] = {"exact: one bucket per box", "linear: 7x + 5y + 3z", "powers: x⁶ + y⁴ + z²",
                                      "brute force"};
static_assert(std::size(kHashNames) == std::size(kHashStudies));

constexpr std::size_t kFolding = 2, kDown = 5;  // rows of frames 30 and 60

const Table& HashTable(const Measured& measured, std::size_t hash) {
  return measured.at(kHashStudies[hash]);
}

/// Of a hash function, over all rows.
double Mean(const Measured& measured, std::size_t hash, const char* column) {
  const std::vector<double> values = HashTable(measured, hash).Column(column);
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / double(std::max<std::size_t>(1, values.size()));
}

PartTable HashFunctions(const Measured& measured) {
  PartTable table{kSelfCollisions,
                  "The hash functions on the falling sheet (selfCollision): means over frames 10, 20, ... 60",
                  {"function of the box", "pairs compared", "of these false", "close pairs", "of these missed",
                   "time per step", "highest, mean y in frame 30", "in frame 60"},
                  {}};
  for (std::size_t hash = 0; hash < std::size(kHashStudies); ++hash) {
    const Table& rows = HashTable(measured, hash);
    const auto heights = [&](std::size_t row) {
      return Text("%.2f, %.2f m", rows.At(row, "highest_y"), rows.At(row, "mean_y"));
    };
    std::vector<std::string> cells = {kHashNames[hash]};
    for (const char* column : {"compared", "false", "close", "missed"})
      cells.push_back(Text("%.0f", Mean(measured, hash, column)));
    cells.insert(cells.end(),
                 {Text("%.3f ms", 1e3 * Mean(measured, hash, "seconds")), heights(kFolding), heights(kDown)});
    table.rows.push_back(std::move(cells));
  }
  table.note =
      "False pairs lie in different boxes but share a bucket: they are compared for nothing. Missed pairs are closer "
      "than 2 · thickness, but their boxes do not meet: the course's method does not look across the borders of boxes, "
      "with any of the functions. Times are of this machine, on one thread.";
  return table;
}

void JudgeHashFunctions(const Measured& measured, Findings& findings) {
  const auto highest = [&](std::size_t hash) { return HashTable(measured, hash).At(kFolding, "highest_y"); };
  const double exact = highest(kExact), linear = highest(kLinear), powers = highest(kPowers), brute = highest(kBrute);
  const double apart = std::max(std::abs(linear - exact), std::abs(powers - exact));
  findings.claims.push_back(
      {"hash-realism",
       kSelfCollisions,
       false,
       "The two hash functions give comparably realistic folds.",
       Text("In frame 30 the sheet's top stands at %.3f m (linear) and %.3f m (powers), with exact boxes at %.3f m, "
            "with brute force at %.3f m. Both let false neighbours in, which costs time and changes little.",
            linear, powers, exact, brute),
       Holds(apart < 0.02),
       {{"linear", linear},
        {"powers", powers},
        {"exact", exact},
        {"brute", brute},
        {"false pairs linear", Mean(measured, kLinear, "false")},
        {"false pairs exact", Mean(measured, kExact, "false")},
        {"missed pairs linear", Mean(measured, kLinear, "missed")},
        {"missed pairs brute", Mean(measured, kBrute, "missed")}}});

  const double slow = Mean(measured, kBrute, "seconds"), fast = Mean(measured, kLinear, "seconds");
  findings.claims.push_back(
      {"brute-slow",
       kSelfCollisions,
       false,
       "Brute force is painfully slow.",
       Text("%.2f ms per step against %.3f ms with the linear function: %.0f times as long, for 2500 points.",
            1e3 * slow, 1e3 * fast, slow / fast),
       Holds(slow / fast > 5),
       {{"times slower", slow / fast}}});

  const double shared = Mean(measured, kPowers, "false");
  findings.claims.push_back(
      {"powers-unique",
       kSelfCollisions,
       false,
       "Even exponents, which take care of negative positions, make the distribution of x⁶ + y⁴ + z² unique.",
       Text("They cannot: boxes on either side of zero share a bucket, since (−x)⁶ = x⁶. On the falling sheet %.0f of "
            "%.0f pairs compared come from another box; negative indices need no special care in the linear function.",
            shared, Mean(measured, kPowers, "compared")),
       Holds(shared == 0),
       {{"false pairs", shared}}});
}

void JudgeWaves(const Measured& measured, Findings& findings) {
  const auto folding = [&](const char* course, std::size_t frame) { return measured.at(course).At(frame, "folding"); };
  const double light = folding(kFoldLight, 40), usual = folding(kFold, 40), dense = folding(kFoldDense, 40);
  findings.claims.push_back(
      {"waves-density",
       kSelfCollisions,
       false,
       "Denser sheets fold in more complex waves.",
       Text("In frame 40 the mean angle between neighbouring squares is %.1f° at 1 g/cm², %.1f° at 15 and %.1f° at "
            "100.",
            light, usual, dense),
       Holds(dense > light),
       {{"folding at 1", light}, {"folding at 15", usual}, {"folding at 100", dense}}});

  const double soft = folding(kFoldSoft, 20), stiff = folding(kFold, 20);
  findings.claims.push_back({"waves-ks",
                             kSelfCollisions,
                             false,
                             "A higher ks gives less complex waves.",
                             Text("In frame 20: %.1f° at 500 N/m, %.1f° at 5000 N/m.", soft, stiff),
                             Holds(soft > stiff),
                             {{"folding at 500", soft}, {"folding at 5000", stiff}}});

  findings.claims.push_back(
      {"dense-flexes",
       kSelfCollisions,
       false,
       "Denser materials flex less, so ks should fall as the mass grows to model a loss of flexibility.",
       Text("The other way round: at equal ks the denser sheet folds more (figures 27 and 28: %.1f° against %.1f°), "
            "and since only ks / density matters, lowering ks as well makes it softer still: figure 6 (ks 5 at 5000 "
            "g/cm²) hangs at %.3f m, figure 5 (ks 5000 at 5 g/cm²) at %.3f m.",
            dense, light, Last(measured.at(kSoftest), "lowest_y"), Last(measured.at(kRatioA), "lowest_y")),
       Holds(dense < light),
       {{"folding at 1", light}, {"folding at 100", dense}}});
}

}  // namespace

void JudgeSelfCollisions(const Measured& measured, Findings& findings) {
  findings.tables.push_back(HashFunctions(measured));
  JudgeHashFunctions(measured, findings);
  JudgeWaves(measured, findings);
}

}  // namespace percale::cli
