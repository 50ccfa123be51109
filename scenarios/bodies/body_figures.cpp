#include "scenarios/bodies/body_figures.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "engine/core/geometry.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/validate.hpp>
namespace lrb::bodies {

double hull_volume(std::span<const Eigen::Vector3d> points) {
  const std::vector<std::array<std::uint32_t, 3>> hull = convex_hull(points);
  if (hull.empty()) return 0;
  const Eigen::Vector3d o = points[hull[0][0]];
  double six = 0;
  for (const auto& [a, b, c] : hull) six += (points[a] - o).dot((points[b] - o).cross(points[c] - o));
  return six / 6;
}

double hull_area(std::span<const Eigen::Vector3d> points) {
  const std::vector<std::uint32_t> outline = convex_outline(points);
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector3d &p = points[outline[i]], &q = points[outline[(i + 1) % outline.size()]];
    twice += p.x() * q.y() - p.y() * q.x();
  }
  return twice / 2;
}

nlohmann::ordered_json body_figures(const LrbRep& rep) {
  const std::uint32_t real = rep.real_face_count(), total = rep.face_count();
  std::vector<FaceId> solid(real);
  for (FaceId f = 0; f < real; ++f) solid[f] = f;
  const std::vector<FaceId> outer(rep.outermost_faces().begin(), rep.outermost_faces().end());
  std::vector<bool> used(rep.vertices().size(), false);
  for (FaceId f = 0; f < real; ++f)
    for (const VertexId v : rep.face(f)) used[v] = true;
  std::vector<Eigen::Vector3d> points;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) points.push_back(rep.vertices()[v]);

  nlohmann::ordered_json j;
  j["name"] = rep.name();
  j["dim"] = rep.dim();
  j["closed"] = rep.closed();
  j["real_faces"] = real;
  j["pseudo_faces"] = total - real;
  j["total_faces"] = total;
  j["total_per_real"] = static_cast<double>(total) / std::max(1u, real);
  j["outer_faces"] = outer.size();
  j["regions"] = rep.region_count();
  j["layers"] = rep.layer_count();
  j["volume_solid"] = enclosed_volume(rep, solid);
  j["volume_outer"] = enclosed_volume(rep, outer);
  j["volume_hull"] = rep.dim() == 3 ? hull_volume(points) : hull_area(points);
  j["bytes"] = rep.memory_bytes();
  j["bytes_per_real_face"] = static_cast<double>(rep.memory_bytes()) / std::max(1u, real);
  return j;
}

Wrapper wrapper_at(const LrbRep& rep, double tolerance, unsigned threads) {
  // Empty: no region is included at any tolerance.
  const std::span<const double> needed = rep.levels(threads).needed();
  Wrapper wrapper(rep);
  for (RegionId r = 0; r < rep.region_count(); ++r)
    if (needed.empty() || !(needed[r] <= tolerance)) wrapper.refine(r);
  return wrapper;
}

std::vector<LevelFigures> level_figures(const LrbRep& rep, std::span<const double> shares, unsigned threads) {
  const std::span<const double> needed = rep.levels(threads).needed();
  Eigen::AlignedBox3d box;  // of the real faces
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) box.extend(rep.vertices()[v]);
  const double size = box.isEmpty() ? 0 : box.sizes().maxCoeff();
  std::vector<LevelFigures> out;
  for (const double share : shares) {
    LevelFigures level{share, share * size, 0, 0};
    const Wrapper wrapper = wrapper_at(rep, level.tolerance, threads);
    for (RegionId r = 0; r < rep.region_count(); ++r)
      if (wrapper.included(r)) level.bound = std::max(level.bound, needed[r]);
    level.faces = static_cast<std::uint32_t>(wrapper.boundary_size());
    out.push_back(level);
  }
  return out;
}

nlohmann::ordered_json level_json(std::span<const LevelFigures> levels) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const LevelFigures& l : levels)
    out.push_back({{"share", l.share}, {"tolerance", l.tolerance}, {"faces", l.faces}, {"bound", l.bound}});
  return out;
}

namespace {

double number_of(const RegionFigures& r, RegionOrder order) {
  switch (order) {
    case RegionOrder::thickness:
      return r.thickness;
    case RegionOrder::volume:
      return r.volume;
    case RegionOrder::lids:
      return r.lids;
    default:
      return r.waste;
  }
}

std::vector<RegionFigures> in_order_of_numbers(const LrbRep& rep) {
  const double wrapper = enclosed_volume(rep, rep.outermost_faces());
  std::vector<RegionFigures> out;
  for (RegionId r = 0; r < rep.region_count(); ++r) {
    RegionFigures& f = out.emplace_back();
    f.region = r;
    f.layer = rep.layer(r);
    f.lids = static_cast<std::uint32_t>(rep.lids(r).size());
    f.floor = static_cast<std::uint32_t>(rep.floor(r).size());
    f.volume = std::max(0.0, region_volume(rep, r));
    f.parent = rep.parent(r);
    f.waste = wrapper > 0 ? f.floor * (f.volume / wrapper) : 0;
  }
  return out;
}

RepFigures figures_of(const LrbRep& rep) {
  const nlohmann::ordered_json j = body_figures(rep);
  RepFigures out;
  out.total_per_real = j["total_per_real"];
  out.outer_faces = j["outer_faces"];
  const double hull = j["volume_hull"];
  out.outer_per_hull = hull > 0 ? j["volume_outer"].get<double>() / hull : 0;
  out.waste = total_waste(in_order_of_numbers(rep));
  return out;
}

std::string rounded(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

struct Setting {
  const char* text;
  std::uint32_t patch, outer;
  bool lean;
};
constexpr Setting kTried[] = {{"--patch 8", 8, 20, false},       {"--patch 40", 40, 20, false},
                              {"--max-outer 40", 16, 40, false}, {"--max-outer 80", 16, 80, false},
                              {"--lean", 16, 20, true},          {"--lean --patch 40", 40, 20, true}};

/// Returns the sizes of a body along its principal axes, ascending.
Eigen::Vector3d principal_sizes(const LrbRep& rep) {
  std::vector<Eigen::Vector3d> points;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) points.push_back(rep.vertices()[v]);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : points) box.extend(x);
  const Eigen::Vector3d centre = box.center();
  const double unit = std::max(box.sizes().maxCoeff(), std::numeric_limits<double>::min());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& x : points) {
    const Eigen::Vector3d d = (x - centre) / unit;
    spread += d * d.transpose();
  }
  const Eigen::Matrix3d axes = eigenvectors_of_symmetric(spread);
  Eigen::AlignedBox3d turned;
  for (const Eigen::Vector3d& x : points) turned.extend(axes.transpose() * ((x - centre) / unit));
  Eigen::Vector3d sizes = turned.sizes() * unit;
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

/// Explains why the outermost wrapper is much larger than the convex hull.
std::string why_loose(const LrbRep& rep) {
  constexpr double kThin =
      20;  // at this ratio of length to thickness the wrapper's clearance is 10 % of the thickness
  const Eigen::Vector3d sizes = principal_sizes(rep);
  if (rep.dim() == 3 && sizes[2] > kThin * sizes[0])
    return "the body is " + (sizes[0] > 0 ? rounded(sizes[2] / sizes[0]) : "infinitely many") +
           " times as long as it is thick, and the wrapper keeps a distance of 0.5 % of the length on each "
           "side";
  return "more faces are needed for a tighter fit; try --max-outer";
}

/// Names the region that refines a large part of the body at once; empty if there is none.
std::string crowded_region(const LrbRep& rep) {
  // At least kFew faces, and 1 / kPart of the real faces.
  constexpr std::size_t kFew = 200, kPart = 10;
  RegionId worst(0);
  for (RegionId r = 0; r < rep.region_count(); ++r)
    if (rep.floor(r).size() > rep.floor(worst).size()) worst = r;
  const std::size_t faces = rep.floor(worst).size();
  if (faces < kFew || faces * kPart < rep.real_face_count()) return {};
  return "region " + std::to_string(worst) + " exposes " + std::to_string(faces) + " faces at once";
}

/// Returns the cause and a remedy if an LRB-rep is poor for reasons other than its options; empty if no cause
/// is known.
std::string cause_of_waste(const LrbRep& rep) {
  if (rep.self_intersecting())
    return "its surface intersects itself, and intersecting faces cannot be covered; repair it or compute the "
           "union of the overlapping parts first (lrbscope inspect lists these faces, --draw shows them)";
  if (const std::size_t pieces = rep.component_vertices().size(); pieces > 1)
    return "it has " + std::to_string(pieces) + " components, each with its own wrappers";
  return {};
}

}  // namespace

std::vector<RegionFigures> region_figures(const LrbRep& rep, RegionOrder order, unsigned threads) {
  std::vector<RegionFigures> out = in_order_of_numbers(rep);
  const std::vector<double> thickness = region_thickness(rep, threads);
  for (RegionFigures& r : out) r.thickness = thickness[r.region];
  std::stable_sort(out.begin(), out.end(), [order](const RegionFigures& a, const RegionFigures& b) {
    return number_of(a, order) > number_of(b, order);
  });
  return out;
}

double total_waste(std::span<const RegionFigures> regions) {
  double sum = 0;
  for (const RegionFigures& r : regions) sum += r.waste;
  return sum;
}

std::vector<double> waste_over_faces(const LrbRep& rep, std::span<const RegionFigures> regions) {
  std::vector<double> share(rep.region_count(), 0), out;
  std::vector<std::uint32_t> faces(rep.region_count(), 0);
  const auto for_each_above = [&](FaceId f, auto visit) {
    for (CellId c = rep.outer_cell(f); is_region(c); c = rep.parent(c.as_region())) visit(c.as_region());
  };
  for (FaceId f = 0; f < rep.real_face_count(); ++f) for_each_above(f, [&](RegionId r) { ++faces[r]; });
  for (const RegionFigures& r : regions)
    if (faces[r.region] > 0) share[r.region] = r.waste / faces[r.region];
  for (FaceId f = 0; f < rep.real_face_count(); ++f) {
    double sum = 0;
    for_each_above(f, [&](RegionId r) { sum += share[r]; });
    out.push_back(sum);
  }
  return out;
}

std::vector<Trial> try_settings(const LrbRep& rep, unsigned threads) {
  std::vector<Trial> out = {{"", figures_of(rep)}};
  const CheckedMesh mesh = check(rep.real_mesh());
  for (const Setting& s : kTried) {
    BuildOptions options;
    options.patch_interior = s.patch;
    options.max_outer_faces = s.outer;
    options.lean = s.lean;
    options.threads = threads;
    const auto begin = std::chrono::steady_clock::now();
    const LrbRep built = build_lrb(mesh, options);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    out.push_back({s.text, figures_of(built)});
    out.back().figures.seconds = seconds.count();
  }
  return out;
}

std::vector<std::string> advice(const LrbRep& rep, std::span<const Trial> trials) {
  constexpr double kWorth = 0.95;  // of the current value: smaller gains depend on the seed
  const RepFigures& now = trials[0].figures;
  const auto least = [&](auto number) -> const Trial& {
    return *std::min_element(trials.begin(), trials.end(), [&](const Trial& a, const Trial& b) {
      return number(a.figures) < number(b.figures);
    });
  };
  const auto change = [](double from, double to) { return rounded(to) + " instead of " + rounded(from); };
  std::vector<std::string> out;
  const Trial& tight = least([](const RepFigures& f) { return f.waste; });
  if (now.waste > kPoorWaste && tight.figures.waste >= kWorth * now.waste) {
    const std::string cause = cause_of_waste(rep);
    return {"no setting lowers the waste of " + rounded(now.waste) + " (" + kUsualWaste +
            ") by more than 5 %" + (cause.empty() ? "" : ": " + cause)};
  }
  if (tight.figures.waste < kWorth * now.waste)
    out.push_back(tight.setting + " has the lowest waste: " + change(now.waste, tight.figures.waste) +
                  " faces per point, with " + change(now.total_per_real, tight.figures.total_per_real) +
                  " faces per real face");
  const Trial& small = least([](const RepFigures& f) { return f.total_per_real; });
  if (small.figures.total_per_real < kWorth * now.total_per_real)
    out.push_back(small.setting +
                  " has the fewest faces: " + change(now.total_per_real, small.figures.total_per_real) +
                  " per real face, with a waste of " + change(now.waste, small.figures.waste));
  const Trial& close = least([](const RepFigures& f) { return f.outer_per_hull; });
  if (close.figures.outer_per_hull < kWorth * now.outer_per_hull)
    out.push_back(close.setting + " has the closest outermost wrapper: " +
                  change(now.outer_per_hull, close.figures.outer_per_hull) +
                  " times the convex hull, with a waste of " + change(now.waste, close.figures.waste));
  if (out.empty()) out.emplace_back("no setting tried is more than 5 % better");
  return out;
}

std::string poor_line(const LrbRep& rep, const BuildOptions& build) {
  constexpr double kLoose = 2, kMany = 2.5, kOpen = 2;            // 1.1 to 1.4, 1.5 to 2, and 1 are typical
  if (rep.real_face_count() <= build.max_outer_faces) return {};  // such small bodies need no wrapper
  if (rep.region_count() == 0) return rep.name() + ": has no regions, so every query starts from its faces";
  const RepFigures f = figures_of(rep);
  std::vector<std::string> faults;
  if (f.waste > kPoorWaste)
    faults.push_back("a random point in its outermost wrapper needlessly exposes " + rounded(f.waste) +
                     " faces on average (" + kUsualWaste + ")");
  if (f.outer_per_hull > kLoose)
    faults.push_back("its outermost wrapper has " + rounded(f.outer_per_hull) + " times the convex hull's " +
                     (rep.dim() == 2 ? "area: " : "volume: ") + why_loose(rep));
  if (f.outer_faces > kOpen * build.max_outer_faces)
    faults.push_back("its outermost wrapper has " + std::to_string(f.outer_faces) + " faces instead of " +
                     std::to_string(build.max_outer_faces) +
                     ", because no simpler surface was proven to enclose it");
  if (f.total_per_real > kMany)
    faults.push_back("it has " + rounded(f.total_per_real) +
                     " faces per real face, because patches of this size save little");
  if (const std::string crowd = crowded_region(rep); !crowd.empty()) faults.push_back(crowd);
  if (faults.empty()) return {};
  std::string line = rep.name() + ": low-quality LRB-rep: ";
  for (std::size_t i = 0; i < faults.size(); ++i) line += (i > 0 ? "; " : "") + faults[i];
  if (const std::string cause = cause_of_waste(rep); !cause.empty()) line += "; " + cause;
  if (!rep.self_intersecting())
    line += "; lrbscope inspect --regions --try shows where, and which settings help";
  return line;
}

}  // namespace lrb::bodies
