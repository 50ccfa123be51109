// Coarse queries beside exact ones of the same bodies and poses, in one run, on one core.
//
//   coarse_bench [speed|bound|time]... [--poses N] [--repeats N] [--draw FILE] [BODY...]
//
// speed: how long answers to a tolerance take, against exact ones, and within limits that are large enough
//        for the exact answer; what the first coarse query costs, and the second.
// bound: the error bound against the distance that pairs really are off the bodies.
// time:  what is known after which time, and by how much limits in time are missed; gnuplot draws it with
//        --draw.
//
// BODY: a mesh or an .lrb file, which meets a copy of itself; without any those of ../shared/meshes, and a
// rock of a million faces made here. Tolerances are shares of the largest side of its box. Times are the
// least of some runs (`time`: of single runs), medians over poses.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "scenarios/bodies/shapes.hpp"
#include "scenarios/report/gnuplot.hpp"
#include "tests/bench/approaches.hpp"
#include "tests/bench/timing.hpp"
#include "tests/support/coarse_checks.hpp"
#include "tests/support/shared_meshes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>

using namespace lrb;
using bench::Approach;
using bench::best_microseconds;
using bench::median;

namespace {

struct PoseClass {
  const char* name;
  double depth;  ///< how far B goes beyond first contact, in diagonals of the body; negative: apart
};
constexpr PoseClass kShallow = {"shallow 1 %", 0.01}, kDeep = {"deep 10 %", 0.1};
constexpr PoseClass kClasses[] = {
    {"apart 0.5 %", -0.005}, {"touching", 0}, {"barely 0.1 %", 0.001}, kShallow, kDeep};
constexpr double kTolerances[] = {0.01, 0.02};
constexpr const char* kModels[] = {"spot.obj", "rocker-arm.obj", "nefertiti.obj"};

struct Options {
  std::set<std::string> parts;
  std::vector<std::string> bodies;
  int poses = 30, repeats = 7;
  std::string drawing;  ///< file for the curves of error bound against time
};

/// How the error bound of one body falls: rows of limit (us) and bound (share of the size).
struct Curve {
  std::string name;
  std::vector<std::string> rows;
};

struct Body {
  std::string name;
  LrbRep rep;
  double size, diagonal;  ///< largest side and diagonal of its box

  Body(std::string n, LrbRep r) : name(std::move(n)), rep(std::move(r)) {
    const auto box = shapes::box_of(rep);
    size = box.sizes().maxCoeff();
    diagonal = box.diagonal().norm();
  }
};

CollideResult ask(const Body& body, const Pose& pose, const CollideRequest& request, QueryContext& context) {
  NullProbe probe;
  return collide(body.rep, Pose{}, body.rep, pose, request, context, probe);
}

CollideRequest within(const Body& body, double share) {
  CollideRequest request;
  request.tolerance = share * body.size;
  return request;
}

/// What one kind of question takes over some poses.
struct Taken {
  std::vector<double> us, times_faster;
  double pairs = 0, total_us = 0;

  double pair_ns() const { return pairs > 0 ? 1000 * total_us / pairs : 0; }
};

void speed_of(const Body& body, const PoseClass& c, const std::vector<Approach>& list, int repeats) {
  std::vector<CollideRequest> requests(1);
  for (const double share : kTolerances) requests.push_back(within(body, share));
  requests.emplace_back().max_tests = ~std::uint64_t{0};
  std::vector<Taken> taken(requests.size());
  QueryContext context;
  for (const Approach& approach : list) {
    const Pose pose = approach.beyond(c.depth * body.diagonal);
    for (std::size_t i = 0; i < requests.size(); ++i) {
      Taken& t = taken[i];
      CollideResult r;
      t.us.push_back(best_microseconds(repeats, [&] { r = ask(body, pose, requests[i], context); }));
      t.times_faster.push_back(taken[0].us.back() / t.us.back());
      t.pairs += static_cast<double>(r.pairs.size());
      t.total_us += t.us.back();
    }
  }
  const auto count = static_cast<double>(list.size());
  std::printf("%-16s %-12s %8.2f us %6.0f pairs %5.0f ns", body.name.c_str(), c.name, median(taken[0].us),
              taken[0].pairs / count, taken[0].pair_ns());
  const auto least = [](const Taken& t) {
    return *std::min_element(t.times_faster.begin(), t.times_faster.end());
  };
  for (std::size_t i = 0; i < std::size(kTolerances); ++i) {
    const Taken& t = taken[i + 1];
    std::printf(" | %g: %8.2f us %5.0f pairs %5.0f ns  %6.2fx, least %.2fx", kTolerances[i], median(t.us),
                t.pairs / count, t.pair_ns(), median(t.times_faster), least(t));
  }
  const Taken& limited = taken.back();
  std::printf(" | limits: %.2f us  %.2fx, least %.2fx\n", median(limited.us), median(limited.times_faster),
              least(limited));
}

void speed(const Body& body, const std::vector<Approach>& list, const Options& options) {
  const Pose pose = list[0].beyond(0.1 * body.diagonal);
  QueryContext context;
  const auto once = [&](const CollideRequest& request) {
    return best_microseconds(1, [&] { ask(body, pose, request, context); });
  };
  const double exact[] = {once({}), once({})};
  const CollideRequest coarse = within(body, kTolerances[0]);
  const double first = once(coarse), second = once(coarse);
  std::printf("%-16s exact: first %.1f us, second %.1f us; at %g: first %.1f us, second %.1f us\n",
              body.name.c_str(), exact[0], exact[1], kTolerances[0], first, second);
  for (const PoseClass& c : kClasses) speed_of(body, c, list, options.repeats);
}

/// Returns the most that a pair of an answer is off; of many pairs looks at some, evenly chosen.
double off_of(const test::RealSurfaces& real, const std::vector<SimplexPair>& pairs) {
  constexpr std::size_t kMost = 200;
  double most = 0;
  const std::size_t step = 1 + pairs.size() / kMost;
  for (std::size_t i = 0; i < pairs.size(); i += step) most = std::max(most, real.off(pairs[i]));
  return most;
}

void bound(const Body& body, const std::vector<Approach>& list, const Options&) {
  QueryContext context;
  for (const double share : kTolerances) {
    std::vector<double> ratios, bounds;
    for (const Approach& approach : list) {
      const Pose pose = approach.beyond((ratios.size() % 2 == 0 ? kShallow : kDeep).depth * body.diagonal);
      const CollideResult r = ask(body, pose, within(body, share), context);
      if (r.error_bound == 0) continue;
      const double off = off_of(test::RealSurfaces(body.rep, Pose{}, body.rep, pose), r.pairs);
      if (off > r.error_bound) std::printf("%s: THE ERROR BOUND IS TOO SMALL\n", body.name.c_str());
      ratios.push_back(r.error_bound / off);
      bounds.push_back(r.error_bound / body.size);
    }
    if (ratios.empty()) continue;
    std::sort(ratios.begin(), ratios.end());
    std::printf(
        "%-16s at %g: error bound %.4f of the size; over what pairs are off: median %.2f, most %.2f\n",
        body.name.c_str(), share, median(bounds), median(ratios), ratios.back());
  }
}

Curve time(const Body& body, const std::vector<Approach>& list, const Options& options) {
  QueryContext context;
  Curve curve{body.name, {}};
  std::printf(
      "# %s: limit us; took us, median and 95 %%; relation known and finished, shares; error bound, share of "
      "the size, median\n",
      body.name.c_str());
  for (double limit = 1; limit <= 4096; limit *= std::sqrt(2.0)) {
    std::vector<double> took, bounds;
    double known = 0, finished = 0;
    CollideRequest request;
    request.max_time = 1e-6 * limit;
    for (const Approach& approach : list)
      for (int i = 0; i < options.repeats; ++i) {
        CollideResult r;
        const Pose pose = approach.beyond(kDeep.depth * body.diagonal);
        took.push_back(best_microseconds(1, [&] { r = ask(body, pose, request, context); }));
        bounds.push_back(r.error_bound / body.size);
        known += r.relation != Relation::unresolved;
        finished += r.finished;
      }
    std::sort(took.begin(), took.end());
    const auto count = static_cast<double>(took.size());
    const double bound = median(bounds);
    std::printf("%6.0f %8.1f %8.1f %6.2f %6.2f %10.5f\n", limit, median(took),
                took[static_cast<std::size_t>(0.95 * count)], known / count, finished / count, bound);
    if (std::isfinite(bound)) curve.rows.push_back(io::number_text(limit) + " " + io::number_text(bound));
  }
  return curve;
}

void draw(const std::vector<Curve>& curves, const std::string& path) {
  report::Gnuplot chart;
  std::string plots;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::string id = "body" + std::to_string(i);
    chart.add_data(id, curves[i].rows);
    plots += (i == 0 ? "plot $" : ", $") + id +
             " using 1:($2 > 0 ? $2 : 0.0005) with linespoints lw 1.5 pt 7 ps 0.4 title " +
             report::gnuplot_text(curves[i].name);
  }
  chart.script += R"(set logscale xy
set yrange [0.0004:1]
set ytics add ('exact' 0.0005)
set xlabel 'limit in time, microseconds'
set ylabel 'error bound, share of the size (median over poses)'
set grid x y lc rgb '#dddddd'
set border 3
set tics nomirror out
)" + plots + "\n";
  report::draw(chart, path);
}

LrbRep load(const std::string& path) {
  return path.ends_with(".lrb") ? load_lrb(path) : build_lrb(read_mesh(path));
}

std::string name_of(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

void run(Body body, const Options& options, std::vector<Curve>& curves) {
  const auto start = std::chrono::steady_clock::now();
  body.rep.levels();
  std::printf("%s: %u faces, levels made in %.3f s\n", body.name.c_str(), body.rep.real_face_count(),
              bench::seconds_since(start));
  const std::vector<Approach> list = bench::approaches(body.rep, body.rep, body.diagonal, options.poses);
  const auto wanted = [&](const char* part) { return options.parts.empty() || options.parts.contains(part); };
  if (wanted("speed")) speed(body, list, options);
  if (wanted("bound")) bound(body, list, options);
  if (wanted("time")) curves.push_back(time(body, list, options));
}

Options options_of(int argc, char** argv) {
  Options o;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "speed" || word == "bound" || word == "time")
      o.parts.insert(word);
    else if (word == "--poses" && i + 1 < argc)
      o.poses = std::atoi(argv[++i]);
    else if (word == "--repeats" && i + 1 < argc)
      o.repeats = std::atoi(argv[++i]);
    else if (word == "--draw" && i + 1 < argc)
      o.drawing = argv[++i];
    else
      o.bodies.push_back(word);
  }
  return o;
}

}  // namespace

int main(int argc, char** argv) {
  Options options = options_of(argc, argv);
  if (options.poses < 1 || options.repeats < 1) {
    std::fprintf(
        stderr,
        "usage: coarse_bench [speed|bound|time]... [--poses N] [--repeats N] [--draw FILE] [BODY...]\n");
    return 2;
  }
  const bool chosen = !options.bodies.empty();
  if (!chosen && !test::shared_meshes().empty())
    for (const char* model : kModels) options.bodies.push_back((test::shared_meshes() / model).string());
  std::vector<Curve> curves;
  for (const std::string& path : options.bodies) run(Body(name_of(path), load(path)), options, curves);
  if (!chosen) run(Body("rock", build_lrb(shapes::bumpy_sphere(8, 1, 0.3))), options, curves);
  if (!options.drawing.empty() && !curves.empty()) draw(curves, options.drawing);
}
