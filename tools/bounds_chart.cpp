#include "tools/bounds_chart.hpp"

#include <algorithm>
#include <cmath>

#include <lrbscope/core/strings.hpp>

namespace lrb::cli {
namespace {

constexpr const char* kLower = "#0072b2";
constexpr const char* kUpper = "#d55e00";
constexpr const char* kAxes =
    "set grid lc rgb '#dddddd'\nset border 3\nset tics nomirror out\nset format '%g'\n";

/// Adds a curve as data, if it has any points. Returns the plot command for it.
std::string curve(report::Gnuplot& chart, const std::string& name, const std::vector<std::string>& rows,
                  const std::string& title, const char* colour) {
  if (rows.empty()) return {};
  chart.add_data(name, rows);
  const std::string look = rows.size() > 1 ? "steps lw 2" : "points pt 7";
  return "$" + name + " using 1:2 with " + look + " lc rgb '" + colour + "' title " +
         report::gnuplot_text(title);
}

std::string joined(const std::vector<std::string>& plots) {
  std::string out;
  for (const std::string& plot : plots)
    if (!plot.empty()) out += (out.empty() ? "plot " : ", ") + plot;
  return out.empty() ? out : out + "\n";
}

std::string row(std::uint64_t work, double value) {
  return std::to_string(work) + " " + io::number_text(value);
}

/// Two curves that bracket a number, as rows of data.
struct Ends {
  std::vector<std::string> lower, upper;
  void add(std::uint64_t work, double low, double high) {
    lower.push_back(row(work, low));
    if (std::isfinite(high)) upper.push_back(row(work, high));
  }
};

}  // namespace

report::Gnuplot bounds_chart(const std::vector<Bounds>& course, const std::string& what,
                             const std::string& work) {
  report::Gnuplot g;
  g.height = 150;
  Ends ends;
  std::vector<std::string> widths;
  for (const Bounds& b : course) {
    ends.add(b.work, b.lower, b.upper);
    if (b.upper > b.lower && std::isfinite(b.upper)) widths.push_back(row(b.work, b.upper - b.lower));
  }
  const std::string lower = curve(g, "lower", ends.lower, what + ", lower bound", kLower);
  const std::string upper = curve(g, "upper", ends.upper, what + ", upper bound", kUpper);
  const std::string width = curve(g, "width", widths, "width of the interval", "#333333");
  g.script += std::string(kAxes) + "set multiplot layout 2,1\nset xrange [0:*]\nset key right\nset ylabel " +
              report::gnuplot_text(what) + "\n" + joined({lower, upper}) + "set xlabel " +
              report::gnuplot_text(work) + "\nset ylabel 'width'\nset logscale y\n" + joined({width}) +
              "unset multiplot\n";
  return g;
}

report::Gnuplot contact_chart(const std::vector<ContactBounds>& course) {
  report::Gnuplot g;
  g.height = 150;
  Ends time, distance;
  for (const ContactBounds& b : course) {
    time.add(b.work, b.t0, b.t1);
    distance.add(b.work, b.lower, b.upper);
  }
  const std::string t0 = curve(g, "t0", time.lower, "no contact before this t", kLower);
  const std::string t1 = curve(g, "t1", time.upper, "in contact by this t", kUpper);
  const std::string low = curve(g, "low", distance.lower, "distance at that t, lower bound", kLower);
  const std::string high = curve(g, "high", distance.upper, "upper bound", kUpper);
  g.script += std::string(kAxes) +
              "set multiplot layout 2,1\nset key bottom right\nset ylabel 't'\nset yrange [0:1]\n" +
              joined({t0, t1}) +
              "set xlabel 'time intervals, steps and exact queries'\nset ylabel 'distance'\n" +
              "set yrange [0:*]\nset key top right\n" + joined({low, high}) + "unset multiplot\n";
  return g;
}

render::Look look_of(const DrawOptions& options) {
  render::FrameSpec look;
  look.width = run::kAnswerWidth;
  look.height = run::kAnswerHeight;
  apply(options.look, look);
  return look;
}

void add_draw_options(CLI::App& app, DrawOptions& options, const std::string& picture, bool with_course) {
  app.add_option("--draw", options.picture, picture + "; for several poses, one numbered file each")
      ->type_name("PNG");
  app.add_option("--size", options.look.size, "Picture size, in pixels [1200x750]")->type_name("WxH");
  add_up_option(app, options.look.camera.up);
  app.add_option("--chart", options.chart,
                 "Chart the convergence of the bounds over the work done, as .svg, .png or .pdf (needs "
                 "gnuplot)")
      ->check(CLI::Validator(
          [](const std::string& path) {
            const bool known = path.ends_with(".svg") || path.ends_with(".png") || path.ends_with(".pdf");
            return known ? std::string() : path + ": expected a file name that ends in .svg, .png or .pdf";
          },
          ""))
      ->type_name("FILE");
  if (with_course)
    app.add_flag("--course", options.course, "Add the convergence history: [work, lower, upper]");
}

}  // namespace lrb::cli
