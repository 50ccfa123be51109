#include <algorithm>
#include <span>

#include "bench/speed/chart_page.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::speed {
namespace {

/// Returns the panels of these names, or all rows with points.
std::vector<report::Chart> printed_panels(Quantity quantity, const std::vector<DataSet>& sets,
                                          const std::vector<Missing>& missing,
                                          const std::vector<report::Chart>& charts,
                                          const std::vector<std::string>& names) {
  const std::span<const PoseClass> classes = classes_of(quantity);
  std::vector<bool> is_known(names.size());
  std::vector<report::Chart> out;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    std::vector<report::Chart> row;
    bool has_points = false;
    for (std::size_t c = 0; c < classes.size(); ++c) {
      const report::Chart& chart = charts[s * classes.size() + c];
      const std::string pose(name_of(classes[c]));
      bool is_named = names.empty();
      for (std::size_t n = 0; n < names.size(); ++n)
        if (names[n] == sets[s].name || names[n] == pose || names[n] == sets[s].name + "/" + pose)
          is_known[n] = is_named = true;
      const bool is_empty = std::all_of(chart.series.begin(), chart.series.end(),
                                        [](const report::Series& one) { return one.x.empty(); });
      if (!is_named || (is_empty && !names.empty())) continue;
      row.push_back(chart);
      if (is_empty || has_points) continue;
      has_points = true;
      const auto lacks = std::find_if(missing.begin(), missing.end(), [&](const Missing& m) {
        return m.set == sets[s].name && m.missing > 0;
      });
      if (lacks != missing.end()) row.back().title += ", UNFINISHED";
    }
    if (has_points) out.insert(out.end(), row.begin(), row.end());
  }
  for (std::size_t n = 0; n < names.size(); ++n)
    if (!is_known[n]) {
      std::string known;
      for (const DataSet& set : sets) known += set.name + ", ";
      for (const PoseClass c : classes) known += std::string(name_of(c)) + ", ";
      throw InputError("unknown panel '" + printable_name(names[n]) + "'; known: " + known +
                       "and both as BODIES/CLASS");
    }
  return out;
}

}  // namespace

report::Gnuplot accuracy_print(Quantity quantity, const std::vector<DataSet>& sets,
                               const std::vector<Missing>& missing, const std::vector<report::Chart>& charts,
                               const ChartPrint& print) {
  constexpr double kPanel = 44;  // millimetres, without a width
  const auto classes = static_cast<int>(classes_of(quantity).size());
  const bool is_whole = print.panels.empty();
  const double width = print.width > 0 ? print.width : kPanel * classes;
  std::vector<report::Chart> panels = printed_panels(quantity, sets, missing, charts, print.panels);
  const int count = static_cast<int>(panels.size()), rows = count / classes;
  // A row for each pair of bodies, or if that does not fit, for each class of poses; of some panels, or of
  // one pair, as many columns as fit.
  int columns = std::clamp(report::columns_within(width), 1, std::max(1, count));
  if (is_whole && columns >= classes) {
    columns = classes;
  } else if (is_whole && rows > 1 && columns >= rows) {
    std::vector<report::Chart> turned;
    for (int c = 0; c < classes; ++c)
      for (int r = 0; r < rows; ++r) turned.push_back(panels[static_cast<std::size_t>(r * classes + c)]);
    panels = std::move(turned);
    columns = rows;
  }
  return report::gnuplot(panels, report::layout_for(width, columns, panels));
}

}  // namespace lrb::speed
