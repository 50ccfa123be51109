#include "bench/tails/pose_space.hpp"

#include <algorithm>
#include <cmath>

namespace lrb::tails {
namespace {

/// Returns a point that is uniformly distributed in a ball, without its centre, by rejection from the cube.
template <int n>
Eigen::Matrix<double, n, 1> in_ball(Random& random) {
  constexpr double kTiny = 1e-3;
  while (true) {
    Eigen::Matrix<double, n, 1> x;
    for (int i = 0; i < n; ++i) x[i] = random.in(-1, 1);
    if (const double sq = x.squaredNorm(); sq > kTiny * kTiny && sq < 1) return x;
  }
}

/// Returns a sample of about the standard normal distribution, without functions that processors round
/// differently.
double normal(Random& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.in(0, 1);
  return sum;
}

constexpr double kFirstSigma = 0.1, kGrow = 1.5, kShrink = 0.9, kLeastSigma = 1e-5, kMaxSigma = 0.5;
constexpr std::size_t kBlock = 256;  // random trials asked together

void ask(Search& search, std::span<const Placement> placements, const CostsOf& costs,
         const SearchProgress& progress) {
  const std::vector<double> found = costs(placements);
  for (std::size_t i = 0; i < placements.size(); ++i)
    search.trials.push_back({placements[i], found[i], search.trials.size() + 1});
  progress(search.trials.size());
}

void ask_at_random(Search& search, std::size_t count, Random& random, const CostsOf& costs,
                   const SearchProgress& progress) {
  while (search.random < count) {
    std::vector<Placement> block;
    while (block.size() < kBlock && search.random + block.size() < count)
      block.push_back(random_placement(random));
    search.random += block.size();
    ask(search, block, costs, progress);
  }
}

}  // namespace

Placement random_placement(Random& random) {
  Placement out;
  const Eigen::Vector4d q = in_ball<4>(random).normalized();
  out.turn = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  const Eigen::Vector3d direction = in_ball<3>(random).normalized();
  out.offset = random.in(0, 1) * direction;
  return out;
}

Placement placement_near(const Placement& at, double sigma, Random& random) {
  Placement out = at;
  for (int i = 0; i < 4; ++i) out.turn.coeffs()[i] += sigma * normal(random);
  out.turn.normalize();
  for (int i = 0; i < 3; ++i) out.offset[i] += sigma / 2 * normal(random);
  return out;
}

bool alike(const Placement& p, const Placement& q, double angle, double distance) {
  // The rotations differ by twice the angle of the quaternions.
  const double cosine = std::abs(p.turn.dot(q.turn));
  return cosine > deterministic::cos(angle / 2) && (p.offset - q.offset).norm() < distance;
}

std::vector<Trial> Search::worst(std::size_t most) const {
  std::vector<Trial> sorted = trials;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Trial& p, const Trial& q) { return p.cost > q.cost; });
  std::vector<Trial> out;
  for (const Trial& t : sorted) {
    if (out.size() == most) break;
    if (std::none_of(out.begin(), out.end(), [&](const Trial& o) { return alike(o.at, t.at); }))
      out.push_back(t);
  }
  return out;
}

double Search::highest(std::size_t n) const {
  double out = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(n, trials.size()); ++i) out = std::max(out, trials[i].cost);
  return out;
}

Search search(const SearchOptions& options, const CostsOf& costs, const SearchProgress& progress) {
  Search out;
  Random random(options.seed);
  const auto first = static_cast<std::size_t>(options.random_share * static_cast<double>(options.budget));
  ask_at_random(out, std::min(options.budget, std::max(first, options.starts)), random, costs, progress);
  std::vector<Trial> best = out.worst(options.starts);
  std::vector<double> sigma(best.size(), kFirstSigma);
  while (out.trials.size() < options.budget) {
    std::vector<Placement> steps;
    for (std::size_t i = 0; i < best.size() && out.trials.size() + steps.size() < options.budget; ++i)
      steps.push_back(placement_near(best[i].at, sigma[i], random));
    const std::size_t begin = out.trials.size();
    ask(out, steps, costs, progress);
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const Trial& t = out.trials[begin + i];
      const bool better = t.cost > best[i].cost;
      if (better) best[i] = t;
      sigma[i] = better ? std::min(kMaxSigma, sigma[i] * kGrow) : std::max(kLeastSigma, sigma[i] * kShrink);
    }
  }
  return out;
}

Search random_search(const SearchOptions& options, const CostsOf& costs, const SearchProgress& progress) {
  Search out;
  // search() with this seed uses other random numbers.
  Random random(options.seed ^ 0x72616e646f6d0000);
  ask_at_random(out, options.budget, random, costs, progress);
  return out;
}

}  // namespace lrb::tails
