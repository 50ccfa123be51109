#pragma once
/// Charts of how bounds tightened while a query worked, for `--chart` of distance, sweep and clash.

#include <string>
#include <vector>

#include "render/pictures/answer_picture.hpp"
#include "scenarios/report/gnuplot.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include <lrbscope/distance.hpp>
#include <lrbscope/first_contact.hpp>

namespace lrb::cli {

/// Returns the chart of lower and upper ends against work; `what` names the number, `work` the unit of the
/// work.
report::Gnuplot bounds_chart(const std::vector<Bounds>& course, const std::string& what,
                             const std::string& work);
/// Returns the chart of t0 and t1, and of the distance at t0, against work.
report::Gnuplot contact_chart(const std::vector<ContactBounds>& course);

/// What a command draws of each of its answers.
struct DrawOptions {
  std::string picture, chart;
  PictureOptions look;  ///< of the picture: --size and --up
  bool course = false;  ///< add how bounds tightened to the line

  bool is_watched() const { return course || !chart.empty(); }
};
/// Returns the appearance of pictures. Throws InputError for a size that they cannot have.
render::Look look_of(const DrawOptions& options);
/// Adds --draw, --size, --up, --chart and, unless there is another option for it, --course. `picture`: what
/// --draw draws.
void add_draw_options(CLI::App& app, DrawOptions& options, const std::string& picture,
                      bool with_course = true);

}  // namespace lrb::cli
