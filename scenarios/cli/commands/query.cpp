#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <sstream>

#include "engine/query/collide.hpp"
#include "engine/query/collide_impl.hpp"
#include "scenarios/bodies/body.hpp"
#include "scenarios/cli/command.hpp"
#include "scenarios/cli/options.hpp"
#include "scenarios/cli/progress.hpp"
#include "scenarios/io/pose_file.hpp"
#include "scenarios/run/separation_picture.hpp"
#include "trace/hex.hpp"

namespace lrb::cli {
namespace {

struct QueryOptions {
  std::string a, b, poses, draw;
  CollideRequest request;
  bool pairs = false;
  std::uint32_t repeat = 0;
};

/// Median microseconds of `repeat` runs of one query, in a warm context.
double median_us(const LrbRep& a, const LrbRep& b, const Pose& pose, const QueryOptions& o,
                 QueryContext& context) {
  std::vector<double> us;
  NullProbe probe;
  for (std::uint32_t i = 0; i < o.repeat; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const CollideResult result = collide(a, Pose{}, b, pose, o.request, context, probe);
    us.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
    if (result.mode != o.request.mode) throw std::logic_error("the query changed its mode");
  }
  const std::size_t middle = us.size() / 2;
  std::nth_element(us.begin(), us.begin() + static_cast<std::ptrdiff_t>(middle), us.end());
  return us[middle];
}

std::string list(const std::vector<RegionId>& regions) {
  std::string out = "[";
  for (const RegionId r : regions) out.append(out.size() > 1 ? "," : "").append(std::to_string(r));
  return out + "]";
}

/// PICTURE, or PICTURE with the pose's number where there are several.
std::string picture_name(const std::string& path, std::size_t pose, std::size_t poses) {
  if (poses == 1) return path;
  const std::filesystem::path p(path);
  return (p.parent_path() / (p.stem().string() + "-" + std::to_string(pose) + p.extension().string()))
      .string();
}

std::string line_of(std::size_t pose, const CollideResult& result, const QueryOptions& o, double us,
                    const LrbRep& a, const LrbRep& b) {
  std::ostringstream out;
  out.exceptions(std::ios::badbit);  // out of memory must not cut a line short
  out << "{\"pose\":" << pose << ",\"relation\":\"" << to_string(result.relation)
      << "\",\"pairs\":" << result.pairs.size() << ",\"fingerprint\":\""
      << trace::to_hex(fingerprint(result.pairs)) << "\"";
  if (o.request.recursion != Recursion::complete)
    out << ",\"recursion\":\"" << (o.request.recursion == Recursion::paper ? "paper" : "paper_strict")
        << "\"";
  if (o.request.predicates != Predicates::exact) out << ",\"predicates\":\"floating\"";
  if (o.request.is_coarse()) {
    out << ",\"finished\":" << (result.finished ? "true" : "false") << ",\"error_bound\":";
    std::isfinite(result.error_bound) ? out << result.error_bound : out << "null";
  }
  if (o.request.separation && result.separation)
    out << ",\"separation\":{\"faces\":[" << result.separation->face_count[0] << ","
        << result.separation->face_count[1] << "],\"refined\":[" << list(result.separation->refined[0]) << ","
        << list(result.separation->refined[1]) << "]}";
  if (o.repeat > 0) out << ",\"us\":" << us;
  if (o.pairs) {
    out << ",\"list\":[";
    for (std::size_t i = 0; i < result.pairs.size(); ++i)
      out << (i > 0 ? "," : "") << "[" << result.pairs[i].a << "," << result.pairs[i].b << "]";
    out << "]";
    if (o.request.is_coarse()) {
      out << ",\"pseudo\":[";
      for (std::size_t i = 0; i < result.pairs.size(); ++i)
        out << (i > 0 ? "," : "") << "[" << (a.is_real_simplex(result.pairs[i].a) ? 0 : 1) << ","
            << (b.is_real_simplex(result.pairs[i].b) ? 0 : 1) << "]";
      out << "]";
    }
  }
  out << "}\n";
  return out.str();
}

int run_query(const QueryOptions& o, const Globals& globals) {
  const std::vector<Pose> poses = io::read_poses(o.poses);  // all of them, before anything is printed
  const bodies::LoadedBody a = bodies::load_body(o.a), b = bodies::load_body(o.b);
  note(globals, a.notes);
  note(globals, b.notes);
  QueryContext context;
  NullProbe probe;
  Progress progress("query", poses.size(), globals.quiet);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const CollideResult result = collide(a.rep, Pose{}, b.rep, poses[i], o.request, context, probe);
    const double us = o.repeat > 0 ? median_us(a.rep, b.rep, poses[i], o, context) : 0;
    print(line_of(i, result, o, us, a.rep, b.rep));
    if (!o.draw.empty() && result.separation)
      run::draw_separation(a.rep, Pose{}, b.rep, poses[i], *result.separation,
                           picture_name(o.draw, i, poses.size()));
    progress.set(i + 1);
  }
  return kOk;
}

Command add_query(CLI::App& root, const Globals& globals) {
  CLI::App* app = root.add_subcommand("query", "Exact answers for a list of poses of B, one JSON line each");
  const auto o = std::make_shared<QueryOptions>();
  app->add_option("A", o->a, "Mesh or .lrb file; stays put")->required();
  app->add_option("B", o->b, "Mesh or .lrb file; the poses are applied to it")->required();
  app->add_option("--poses", o->poses, "File of lines of 12 numbers (row-major 3x4)")->required();
  add_request_options(*app, o->request);
  add_coarse_options(*app, o->request);
  auto* separation = app->add_flag("--separation", o->request.separation,
                                   "For separate bodies, the coarsest wrappers that prove it");
  app->add_option("--draw-separation", o->draw, "Draw these wrappers: the picture's name")
      ->needs(separation)
      ->type_name("PNG");
  app->add_flag("--pairs", o->pairs, "Add the sorted list of pairs");
  app->add_option("--repeat", o->repeat, "Add the median microseconds of N repeats of each pose's query")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  return {app, [o, &globals] { return run_query(*o, globals); }};
}

}  // namespace

std::vector<CommandEntry> query_commands() {
  return {{add_query, 40}};
}

}  // namespace lrb::cli
