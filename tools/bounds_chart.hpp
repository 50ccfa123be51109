#pragma once
/// Charts of the convergence of bounds during a query, for `--chart` of distance, sweep and clash.

#include <string>
#include <vector>

#include "render/pictures/answer_picture.hpp"
#include "scenarios/report/chart.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include <lrbscope/distance.hpp>
#include <lrbscope/first_contact.hpp>

namespace lrb::cli {

/// Returns the chart of lower and upper bounds against work. `what`: name of the number; `work`: unit of the
/// work.
report::Gnuplot bounds_chart(const std::vector<Bounds>& history, const std::string& what,
                             const std::string& work);
/// Returns the chart of t0 and t1, and of the distance at t0, against work.
report::Gnuplot contact_chart(const std::vector<ContactBounds>& history);

/// Options for the pictures of a command's answers.
struct DrawOptions {
  std::string picture, chart;
  PictureOptions look;   ///< of the picture: --size and --up
  bool history = false;  ///< add the bound history to the line

  bool is_watched() const { return history || !chart.empty(); }
};
/// Returns the style of the pictures. Throws InputError for an unsupported size.
render::Look look_of(const DrawOptions& options);
/// Adds --draw, --size and --up. `picture`: content of the picture that --draw writes.
void add_picture_options(CLI::App& app, DrawOptions& options, const std::string& picture);
/// Adds these, --chart and, if `with_history`, --convergence.
void add_draw_options(CLI::App& app, DrawOptions& options, const std::string& picture,
                      bool with_history = true);

}  // namespace lrb::cli
