#include "apps/cli/figure_judges.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/text.h"

namespace percale::cli {

Verdict Holds(bool holds) {
  return holds ? Verdict::Holds : Verdict::Fails;
}

bool Ascends(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
}

std::string Meters(double value) {
  return Text("%.3f m", value);
}

std::string Small(double meters) {
  if (meters <= 0) return "0 mm";
  if (meters >= 1e-4) return Text("%.2g mm", meters * 1e3);
  return meters >= 1e-7 ? Text("%.2g µm", meters * 1e6) : Text("%.1e m", meters);
}

std::string Seconds(const std::optional<double>& seconds) {
  return seconds ? Text("%.2f s", *seconds) : "not at all";
}

std::string Joined(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
  }
  return text;
}

PointValue LastOf(const Measured& measured, const char* column) {
  return [&measured, column](const SweepPoint& point) { return Last(measured.at(point.course), column); };
}

PointValue FallTimeOf(const Measured& measured) {
  return [&measured](const SweepPoint& point) { return FallTime(measured.at(point.course)).value_or(NAN); };
}

std::vector<double> Values(std::span<const SweepPoint> sweep, const PointValue& value) {
  std::vector<double> values;
  for (const SweepPoint& point : sweep) values.push_back(value(point));
  return values;
}

std::vector<std::pair<std::string, double>> NamedValues(std::span<const SweepPoint> sweep, const char* what,
                                                        const PointValue& value) {
  std::vector<std::pair<std::string, double>> values;
  for (const SweepPoint& point : sweep) values.push_back({Text("%s at %.6g", what, point.value), value(point)});
  return values;
}

std::string List(std::span<const SweepPoint> sweep, const char* unit,
                 const std::function<std::string(const SweepPoint&)>& say) {
  std::vector<std::string> parts;
  for (const SweepPoint& point : sweep) parts.push_back(say(point) + Text(" at %.6g", point.value) + unit);
  return Joined(parts);
}

Series SweepSeries(const char* name, std::span<const SweepPoint> sweep, const PointValue& value) {
  Series series{name, {}, true};
  for (const SweepPoint& point : sweep) series.points.push_back({point.value, value(point)});
  return series;
}

Plot CoursePlot(const Measured& measured, std::span<const NamedCourse> courses, const char* column) {
  Plot plot;
  plot.x.label = "time [s]";
  for (const NamedCourse& named : courses) {
    const Table& course = measured.at(named.course);
    Series series{named.name, {}, false};
    for (std::size_t i = 0; i < course.rows.size(); ++i)
      series.points.push_back({course.At(i, "time"), course.At(i, column)});
    plot.series.push_back(std::move(series));
  }
  return plot;
}

}  // namespace percale::cli
