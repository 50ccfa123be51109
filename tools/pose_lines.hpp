#pragma once
/// What commands that answer a query for each pose of B share: files and poses, parts of their lines,
/// pictures, and charts of the convergence of bounds.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "render/pictures/answer_picture.hpp"
#include "render/pictures/panel.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/report/chart.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/distance.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/trace/json_write.hpp>

namespace lrb::cli {

// Writes points and witnesses in the form used by `distance` and `sweep`.

inline void write_vector(trace::JsonWriter& w, const char* name, const Eigen::Vector3d& x) {
  w.key(name).begin_array().value(x.x()).value(x.y()).value(x.z()).end_array();
}

/// Writes the closest feature of a face: its kind, and the vertices that span it.
inline void write_feature_of(trace::JsonWriter& w, const Witness& witness) {
  static constexpr const char* kNames[] = {"vertex", "edge", "face"};
  w.member("feature", kNames[witness.corner_count - 1]);
  w.key("vertices").begin_array();
  for (int k = 0; k < witness.corner_count; ++k)
    w.value(witness.corners[static_cast<std::size_t>(k)].value());
  w.end_array();
}

/// Returns the median time in microseconds of `repeat` calls of run_query(); repeat > 0.
template <class Query>
double median_us(std::uint32_t repeat, const Query& run_query) {
  std::vector<double> us;
  for (std::uint32_t i = 0; i < repeat; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    run_query();
    us.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
  }
  const std::size_t median = us.size() / 2;
  std::nth_element(us.begin(), us.begin() + static_cast<std::ptrdiff_t>(median), us.end());
  return us[median];
}

/// The poses of a command, and the location of each in its file.
struct PoseLines {
  /// Reads a file of poses. Without one, B stays in place.
  explicit PoseLines(const std::string& path);

  /// Calls run_query(), and prefixes the message of an InputError with the location of the pose.
  template <class Query>
  auto at(std::size_t i, const Query& run_query) const {
    try {
      return run_query();
    } catch (const InputError& e) {
      throw InputError(places[i] + ": " + e.what());
    }
  }

  /// Throws InputError unless the bodies can be queried at every pose. Called before anything is printed.
  void check(const LrbRep& a, const LrbRep& b) const;

  std::vector<Pose> poses;
  std::vector<std::string> places;
};

/// The files of a command about A and poses of B.
struct PosedFiles {
  bodies::Corners corners = bodies::Corners::joined;
  std::string a, b, poses;
};
/// Adds A, B and --poses.
void add_posed_files(App& app, PosedFiles& files);
/// Loads both bodies without regions, and prints their notes.
std::array<bodies::LoadedBody, 2> load_noted(const std::string& a, const std::string& b,
                                             bodies::Corners corners, const Globals& globals);

/// Loads both bodies, checks them at every pose, and calls visit(bodies, i) for each pose, in order.
template <class Visit>
void for_each_pose(const PosedFiles& files, const PoseLines& list, const char* what, const Globals& globals,
                   const Visit& visit) {
  const std::array<bodies::LoadedBody, 2> both = load_noted(files.a, files.b, files.corners, globals);
  list.check(both[0].rep, both[1].rep);
  Progress progress(what, list.poses.size(), globals.quiet);
  for (std::size_t i = 0; i < list.poses.size(); ++i) {
    visit(run::PosedBodies{both[0].rep, Pose{}, both[1].rep, list.poses[i]}, i);
    progress.set(i + 1);
  }
}

/// Returns a picture's file: `path`, or with the number of the pose before its extension if there are several
/// poses.
std::string picture_name(const std::string& path, std::size_t pose, std::size_t poses);

// Pictures of answers; charts of the convergence of bounds during a query, for `--chart` of distance, sweep
// and clash.

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
void add_picture_options(App& app, DrawOptions& options, const std::string& picture);
/// Adds these, --chart and, if `with_history`, --convergence.
void add_draw_options(App& app, DrawOptions& options, const std::string& picture, bool with_history = true);

}  // namespace lrb::cli
