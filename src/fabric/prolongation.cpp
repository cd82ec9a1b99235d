#include "fabric/prolongation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "mesh/lists.h"

namespace percale::fabric {
namespace {

constexpr double kVerticesPerNode = 4;        // along each axis
constexpr double kSnap = 1e-4;                // of the spacing: so close to a line of nodes a vertex lies on it
constexpr double kSlotsPerRow = 100;          // a grid that needs more is mostly empty
constexpr double kSmoothing = 2.0 / 3;        // 4/3 over the largest eigenvalue, 2, of the scaled Laplacian
constexpr double kLeastCoarsening = 2.0 / 3;  // a level of more nodes than that, per node of the one before, is no gain

bool IsPinned(std::span<const std::uint8_t> pinned, int row) {
  return !pinned.empty() && pinned[row];
}

/// Sorts the entries of a row, adds up those of one column, and makes the sum of all one.
void AppendRow(std::vector<std::pair<std::int32_t, double>>& row, Prolongation& p) {
  std::stable_sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  double sum = 0;
  for (const auto& [column, weight] : row) sum += weight;
  const std::size_t begin = p.column.size();
  for (const auto& [column, weight] : row) {
    if (p.column.size() > begin && p.column.back() == column) {
      p.weight.back() += static_cast<Real>(weight / sum);
    } else {
      p.column.push_back(column);
      p.weight.push_back(static_cast<Real>(weight / sum));
    }
  }
  p.first.push_back(static_cast<std::int32_t>(p.column.size()));
}

/// A place in a panel that a row of a level takes part of its motion from.
struct Sample {
  std::int32_t row, panel;
  double u, v;
};

struct Panel {
  double spacing = 0;  // of nodes [m]
  double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
  int cells[2] = {};
  std::size_t firstSlot = 0;  // of the grid's nodes among those of all panels
};

/// Interpolates from a grid over each panel; `samples` in the order of rows. Replaces them by those of the nodes. Has
/// no nodes where grids would be all but empty: over thin panels askew.
Prolongation CoarsenByGrid(int rows, std::vector<Sample>& samples, std::vector<Panel>& panels) {
  for (Panel& panel : panels) panel = Panel{.spacing = panel.spacing};
  for (const Sample& s : samples) {
    Panel& panel = panels[s.panel];
    const double at[2] = {s.u, s.v};
    for (int axis = 0; axis < 2; ++axis) {
      panel.low[axis] = std::min(panel.low[axis], at[axis]);
      panel.high[axis] = std::max(panel.high[axis], at[axis]);
    }
  }
  double slotsNeeded = 0;
  for (Panel& panel : panels) {
    for (int axis = 0; axis < 2; ++axis) {
      const double cells = panel.spacing > 0 ? std::round((panel.high[axis] - panel.low[axis]) / panel.spacing) : 0;
      panel.cells[axis] = static_cast<int>(std::clamp(cells, 0.0, kSlotsPerRow * rows));
    }
    slotsNeeded += (panel.cells[0] + 1.0) * (panel.cells[1] + 1.0);
  }
  if (slotsNeeded > kSlotsPerRow * rows) return {};
  std::size_t slots = 0;
  for (Panel& panel : panels) {
    panel.firstSlot = slots;
    slots += (static_cast<std::size_t>(panel.cells[0]) + 1) * (static_cast<std::size_t>(panel.cells[1]) + 1);
  }

  // Nodes are numbered in the order in which rows need them: those that are near each other in one level are so in all.
  std::vector<std::int32_t> node(slots, -1);
  std::vector<Sample> nodes;
  Prolongation p;
  p.first.reserve(static_cast<std::size_t>(rows) + 1);
  p.first.push_back(0);
  p.column.reserve(4 * samples.size());
  p.weight.reserve(4 * samples.size());
  std::vector<std::pair<std::int32_t, double>> row;
  const auto finishRows = [&](int end) {
    for (; p.rows() < end; row.clear()) AppendRow(row, p);
  };
  for (const Sample& s : samples) {
    finishRows(s.row);
    const Panel& panel = panels[s.panel];
    const double at[2] = {s.u, s.v};
    int cell[2];
    double share[2];
    for (int axis = 0; axis < 2; ++axis) {
      const double extent = panel.high[axis] - panel.low[axis];
      const double place = panel.cells[axis] > 0 ? (at[axis] - panel.low[axis]) / extent * panel.cells[axis] : 0;
      cell[axis] = std::clamp(static_cast<int>(place), 0, std::max(0, panel.cells[axis] - 1));
      share[axis] = place - cell[axis];
      if (share[axis] < kSnap) share[axis] = 0;
      if (share[axis] > 1 - kSnap) share[axis] = 1;
    }
    for (int corner = 0; corner < 4; ++corner) {
      const int i = cell[0] + corner % 2, j = cell[1] + corner / 2;
      const double weight = (i > cell[0] ? share[0] : 1 - share[0]) * (j > cell[1] ? share[1] : 1 - share[1]);
      if (weight <= 0) continue;
      std::int32_t& number =
          node[panel.firstSlot + static_cast<std::size_t>(j) * (static_cast<std::size_t>(panel.cells[0]) + 1) +
               static_cast<std::size_t>(i)];
      if (number < 0) {
        number = static_cast<std::int32_t>(nodes.size());
        const auto place = [&](int axis, int k) {
          return panel.low[axis] + (panel.high[axis] - panel.low[axis]) * k / std::max(1, panel.cells[axis]);
        };
        nodes.push_back({number, s.panel, place(0, i), place(1, j)});
      }
      row.push_back({number, weight});
    }
  }
  finishRows(rows);
  p.column.shrink_to_fit();
  p.weight.shrink_to_fit();
  p.nodes = static_cast<int>(nodes.size());
  samples = std::move(nodes);
  for (Panel& panel : panels) panel.spacing *= kVerticesPerNode;
  return p;
}

/// Aggregates of the rows that move and, unless `keepAlone`, have neighbours that do: per row the index of its
/// aggregate, or -1.
std::vector<std::int32_t> Aggregate(const BlockPattern& graph, std::span<const std::uint8_t> pinned, bool keepAlone,
                                    int& count) {
  const int n = graph.rows();
  std::vector<std::int32_t> aggregate(n, -1);
  count = 0;
  const auto forNeighbours = [&](int row, auto&& visit) {
    graph.columns.ForRow(row, [&](std::int32_t other, std::int32_t) {
      if (other != row && !IsPinned(pinned, other)) visit(other);
    });
  };
  for (int row = 0; row < n; ++row) {
    if (IsPinned(pinned, row) || aggregate[row] >= 0) continue;
    bool alone = true, free = true;
    forNeighbours(row, [&](std::int32_t other) { alone = false, free = free && aggregate[other] < 0; });
    if (!free || (alone && !keepAlone)) continue;
    aggregate[row] = count;
    forNeighbours(row, [&](std::int32_t other) { aggregate[other] = count; });
    ++count;
  }
  // What is left lies next to an aggregate: to the one that it has most neighbours in, of several the smallest.
  const std::vector<std::int32_t> roots = aggregate;
  std::vector<std::int32_t> votes, size(count, 0);
  for (const std::int32_t a : aggregate) {
    if (a >= 0) ++size[a];
  }
  for (int row = 0; row < n; ++row) {
    if (IsPinned(pinned, row) || aggregate[row] >= 0) continue;
    votes.clear();
    forNeighbours(row, [&](std::int32_t other) {
      if (roots[other] >= 0) votes.push_back(roots[other]);
    });
    std::sort(votes.begin(), votes.end());
    std::int32_t best = -1;
    std::ptrdiff_t most = 0;
    for (auto at = votes.begin(); at != votes.end();) {
      const auto end = std::upper_bound(at, votes.end(), *at);
      if (end - at > most || (end - at == most && size[*at] < size[best])) most = end - at, best = *at;
      at = end;
    }
    aggregate[row] = best;
    if (best >= 0) ++size[best];
  }
  return aggregate;
}

Prolongation CoarsenByAggregates(const BlockPattern& graph, std::span<const std::uint8_t> pinned, bool keepAlone,
                                 BlockPattern& coarseGraph) {
  Prolongation p;
  const std::vector<std::int32_t> aggregate = Aggregate(graph, pinned, keepAlone, p.nodes);
  p.first.push_back(0);
  std::vector<std::pair<std::int32_t, double>> row;
  std::vector<Edge> links;
  for (int r = 0; r < graph.rows(); ++r) {
    row.clear();
    if (aggregate[r] >= 0) {
      int neighbours = 0;
      graph.columns.ForRow(r, [&](std::int32_t column, std::int32_t) {
        const std::int32_t other = aggregate[column];
        if (column == r || other < 0) return;
        ++neighbours;
        row.push_back({other, kSmoothing});
        if (other < aggregate[r]) links.push_back({other, aggregate[r]});
      });
      for (auto& [column, weight] : row) weight /= neighbours;
      row.push_back({aggregate[r], 1 - kSmoothing});  // of a row that is alone made one by AppendRow
    }
    AppendRow(row, p);
  }
  coarseGraph = MakePattern(p.nodes, {}, links);
  return p;
}

}  // namespace

Restriction MakeRestriction(const Prolongation& p) {
  std::vector<std::int32_t> rowOf;  // per entry
  rowOf.reserve(p.column.size());
  for (int row = 0; row < p.rows(); ++row) rowOf.resize(p.first[row + 1], row);
  const Lists byNode = ListBy(p.nodes, p.column.size(), [&](std::size_t e) { return p.column[e]; });
  Restriction restriction;
  RowSharer<std::int32_t> sharer(p.nodes);
  std::vector<std::pair<std::int32_t, std::int32_t>> entries;  // of a node
  for (int node = 0; node < p.nodes; ++node) {
    entries.clear();
    for (std::int32_t k = byNode.first[node]; k < byNode.first[node + 1]; ++k) {
      const std::int32_t e = byNode.entry[k], row = rowOf[e];
      entries.push_back({row, e - p.first[row]});
    }
    const std::int32_t least = entries.empty() ? 0 : entries.front().first;
    restriction.firstRow.push_back(least);
    sharer.Append(entries, least);
  }
  restriction.firstRow.shrink_to_fit();
  restriction.entry = sharer.Take();
  return restriction;
}

BlockPattern CoarsePattern(const BlockPattern& pattern, const Prolongation& p, const Restriction& restriction) {
  PatternMaker coarse(p.nodes);
  std::vector<std::int32_t> seenBy(p.nodes, -1), columns;
  for (int node = 0; node < p.nodes; ++node) {
    columns.clear();
    restriction.ForRow(p, node, [&](std::int32_t row, Real) {
      pattern.columns.ForRow(row, [&](std::int32_t other, std::int32_t) {
        for (std::int32_t e = p.first[other]; e < p.first[other + 1]; ++e) {
          if (std::exchange(seenBy[p.column[e]], node) != node) columns.push_back(p.column[e]);
        }
      });
    });
    std::sort(columns.begin(), columns.end());
    coarse.Append(columns);
  }
  return coarse.Take();
}

std::vector<Prolongation> MaterialHierarchy(int vertices, const MaterialMesh& mesh,
                                            std::span<const std::uint8_t> pinned) {
  const std::size_t points = mesh.material.size();
  if (points == 0 || mesh.materialTriangles.size() != mesh.triangles.size()) return {};
  for (const Vec2& point : mesh.material) {
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) return {};
  }

  // Panels: points of material that triangles connect, the one with the least index first.
  std::vector<std::int32_t> root(points);
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](std::int32_t p) {
    while (root[p] != p) p = root[p] = root[root[p]];
    return p;
  };
  const auto join = [&](std::int32_t a, std::int32_t b) {
    a = find(a), b = find(b);
    root[std::max(a, b)] = std::min(a, b);
  };
  std::vector<std::pair<std::int32_t, std::int32_t>> corners;  // vertex and its point of material
  corners.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle &of = mesh.triangles[t], &m = mesh.materialTriangles[t];
    join(m.a, m.b), join(m.b, m.c);
    corners.insert(corners.end(), {{of.a, m.a}, {of.b, m.b}, {of.c, m.c}});
  }
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());

  std::vector<std::int32_t> panelOf(points, -1);
  std::vector<Panel> panels;
  std::vector<double> area;
  std::vector<int> pointCount;
  for (std::size_t p = 0; p < points; ++p) {
    const std::int32_t top = find(static_cast<std::int32_t>(p));
    if (panelOf[top] < 0) {
      panelOf[top] = static_cast<std::int32_t>(panels.size());
      panels.emplace_back(), area.push_back(0), pointCount.push_back(0);
    }
    panelOf[p] = panelOf[top];
    ++pointCount[panelOf[p]];
  }
  double totalArea = 0, totalExtent = 0;
  for (const Triangle& m : mesh.materialTriangles) {
    const Vec2 a = mesh.material[m.a], b = mesh.material[m.b], c = mesh.material[m.c];
    const double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    area[panelOf[m.a]] += std::abs(twice) / 2;
    totalArea += std::abs(twice) / 2;
    totalExtent = std::max({totalExtent, std::abs(b.x - a.x), std::abs(b.y - a.y)});
  }
  if (!(totalArea > 1e-12 * totalExtent * totalExtent)) return {};
  for (std::size_t k = 0; k < panels.size(); ++k) {
    panels[k].spacing = kVerticesPerNode * std::sqrt(area[k] / pointCount[k]);
  }

  std::vector<Sample> samples;
  samples.reserve(corners.size());
  for (const auto& [vertex, point] : corners) {
    if (IsPinned(pinned, vertex)) continue;
    samples.push_back({vertex, panelOf[point], mesh.material[point].x, mesh.material[point].y});
  }
  corners = {};
  corners.shrink_to_fit();
  std::vector<Prolongation> levels;
  int rows = vertices;
  while (rows > kFewNodes) {
    Prolongation p = CoarsenByGrid(rows, samples, panels);
    if (p.nodes == 0 || p.nodes > kLeastCoarsening * rows) break;
    rows = p.nodes;
    levels.push_back(std::move(p));
  }
  return levels;
}

std::vector<Prolongation> AggregateHierarchy(const BlockPattern& pattern, std::span<const std::uint8_t> pinned) {
  std::vector<Prolongation> levels;
  BlockPattern graph = pattern;
  while (graph.rows() > kFewNodes) {
    BlockPattern coarse;
    const bool vertices = levels.empty();
    Prolongation p = CoarsenByAggregates(graph, vertices ? pinned : std::span<const std::uint8_t>{}, !vertices, coarse);
    if (p.nodes == 0 || p.nodes > kLeastCoarsening * graph.rows()) break;
    levels.push_back(std::move(p));
    graph = std::move(coarse);
  }
  return levels;
}

std::vector<Prolongation> MakeHierarchy(const BlockPattern& pattern, const MaterialMesh& mesh,
                                        std::span<const std::uint8_t> pinned) {
  std::vector<Prolongation> levels = MaterialHierarchy(pattern.rows(), mesh, pinned);
  if (levels.empty()) return AggregateHierarchy(pattern, pinned);
  if (levels.back().nodes > kFewNodes) {
    BlockPattern graph = pattern;
    for (const Prolongation& p : levels) graph = CoarsePattern(graph, p, MakeRestriction(p));
    for (Prolongation& p : AggregateHierarchy(graph)) levels.push_back(std::move(p));
  }
  return levels;
}

}  // namespace percale::fabric
