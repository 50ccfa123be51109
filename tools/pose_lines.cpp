#include "tools/pose_lines.hpp"

#include <cmath>
#include <filesystem>
#include <utility>

#include <lrbscope/collide.hpp>

namespace lrb::tools {

PoseLines::PoseLines(const std::string& path) {
  io::PoseList list = path.empty() ? io::PoseList{{Pose{}}, {"B in place"}} : io::open_poses(path);
  poses = std::move(list.poses);
  places = std::move(list.places);
}

void PoseLines::check(const LrbRep& a, const LrbRep& b) const {
  check_query(a, Pose{}, b, Pose{});
  for (std::size_t i = 0; i < poses.size(); ++i) at(i, [&] { check_query(a, Pose{}, b, poses[i]); });
}

void add_posed_files(App& app, PosedFiles& files) {
  app.add_option("A", files.a, "Mesh or .lrb file; does not move")->required();
  app.add_option("B", files.b, "Mesh or .lrb file; moved to each pose")->required();
  app.add_option("--poses", files.poses, io::kPoseFileHelp + std::string(" [B stays in place]"));
}

std::string picture_name(const std::string& path, std::size_t pose, std::size_t poses) {
  if (poses == 1) return path;
  const std::filesystem::path p(path);
  return (p.parent_path() / (p.stem().string() + "-" + std::to_string(pose) + p.extension().string()))
      .string();
}

namespace {

/// Two panels, one above the other.
report::Gnuplot stacked(const report::Chart& upper, const report::Chart& lower) {
  const report::Chart panels[] = {upper, lower};
  return report::gnuplot(panels, {1, 140, 58});
}

}  // namespace

report::Gnuplot bounds_chart(const std::vector<Bounds>& history, const std::string& what,
                             const std::string& work) {
  report::Ends ends(what, report::Line::steps);
  report::Series width{"width of the interval", {}, {}, {report::Line::steps, "#333333"}};
  for (const Bounds& b : history) {
    const auto x = static_cast<double>(b.work);
    ends.add(x, b.lower, b.upper);
    if (!(b.upper > b.lower) || !std::isfinite(b.upper)) continue;
    width.x.push_back(x);
    width.y.push_back(b.upper - b.lower);
  }
  const report::Axis x{work, false, 0, history.empty() ? 0 : static_cast<double>(history.back().work)};
  report::Chart bounds{"", x, {what}};
  ends.move_to(bounds);
  return stacked(bounds, {"", x, {"width", true}, {width}});
}

report::Gnuplot contact_chart(const std::vector<ContactBounds>& history) {
  report::Ends time("time of impact", report::Line::steps),
      distance("distance at the lower bound", report::Line::steps);
  for (const ContactBounds& b : history) {
    time.add(static_cast<double>(b.work), b.t0, b.t1);
    distance.add(static_cast<double>(b.work), b.lower, b.upper);
  }
  const report::Axis work{"work: intervals, steps and exact queries"};
  report::Chart times{"", work, {"t", false, 0, 1}}, distances{"", work, {"distance"}};
  time.move_to(times);
  distance.move_to(distances);
  return stacked(times, distances);
}

pictures::Look look_of(const DrawOptions& options) {
  pictures::FrameSpec look;
  look.width = pictures::kAnswerWidth;
  look.height = pictures::kAnswerHeight;
  apply(options.look, look);
  return look;
}

void add_picture_options(App& app, DrawOptions& options, const std::string& picture) {
  app.add_option("--draw", options.picture, "PNG", picture + "; for several poses, one numbered file each");
  app.add_option("--size", options.look.size, "WxH", "Picture size, in pixels [1200x750]");
  add_up_option(app, options.look.camera.up);
}

void add_draw_options(App& app, DrawOptions& options, const std::string& picture, bool with_history) {
  add_picture_options(app, options, picture);
  app.add_option("--chart", options.chart, "FILE",
                 "Chart the convergence of the bounds over the work done, as .svg, .png or .pdf (needs "
                 "gnuplot)")
      ->satisfies([](const std::string& path) {
        const bool known = path.ends_with(".svg") || path.ends_with(".png") || path.ends_with(".pdf");
        return known ? std::string() : path + ": expected a file name that ends in .svg, .png or .pdf";
      });
  if (with_history)
    app.add_flag("--convergence", options.history, "Add the convergence history: [work, lower, upper]");
}

}  // namespace lrb::tools
