#include "scenarios/profile/live.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <lrbscope/render/overlay.hpp>

namespace lrb::profile {

using nlohmann::ordered_json;

void RunningPercentile::add(double value) {
  const double at = value > 1 ? std::log2(value) * kPerOctave : 0;
  ++counts_[std::min(counts_.size() - 1, static_cast<std::size_t>(at))];
  ++count_;
}

double RunningPercentile::value() const {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share_ * static_cast<double>(count_)));
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    below += counts_[i];
    if (below >= wanted && below > 0) return std::exp2(static_cast<double>(i + 1) / kPerOctave);
  }
  return 0;
}

namespace {

/// The number of queries after which one can be called slow.
constexpr std::uint64_t kLeastForSlow = 100;
/// Queries with at most this many visits are split into volumes and order, which takes up to 0.2 s.
constexpr std::uint64_t kMaxVisitsToSplitLive = 20'000;

std::uint64_t tests_of(const capture::Query& query) {
  std::uint64_t out = 0;
  for (const capture::Event& e : query.events)
    if (e.kind == capture::EventKind::nodes || e.kind == capture::EventKind::triangles) out += e.tests;
  return out;
}

std::string microseconds(double ns) {
  return render::short_number(ns / 1000) + " us";
}

}  // namespace

LiveQueries::LiveQueries(const capture::Capture& descriptions, const LiveSettings& settings)
    : descriptions_(descriptions), settings_(settings), bodies_(descriptions) {}

void LiveQueries::add(capture::Query query, bool is_to_check) {
  LiveQuery live;
  live.query = std::move(query);
  live.tests = tests_of(live.query);
  const double ns = live.query.duration_ns;
  live.is_slow = p99_.count() >= kLeastForSlow && ns > p99_.value();
  p99_.add(ns);
  median_.add(ns);
  ++count_;
  events_ += live.query.events.size();
  if (is_to_check)
    check(live);
  else
    ++unchecked_;
  // Queries of several threads do not end in the order of their numbers.
  const auto after = std::upper_bound(
      kept_.begin(), kept_.end(), live.query.number,
      [](std::uint32_t number, const LiveQuery& other) { return number < other.query.number; });
  kept_.insert(after, std::move(live));
  forget();
}

void LiveQueries::check(LiveQuery& live) {
  if (const std::array<std::size_t, 2> now{descriptions_.meshes.size(), descriptions_.trees.size()};
      now != known_) {
    bodies_.update();
    checker_.emplace(bodies_, precision_of(descriptions_));
    known_ = now;
  }
  const auto trees = CapturedBodies::trees_of(live.query);
  const auto walk = trees ? std::make_unique<QueryWalk>(bodies_, live.query, *trees) : nullptr;
  live.checked.verdict = checker_->check(live.query, walk.get());
  QueryVerdict& verdict = live.checked.verdict;
  const bool split = walk != nullptr && walk->visits() <= kMaxVisitsToSplitLive;
  live.checked.prices = PriceBook(bodies_).add(live.query, walk.get(), verdict.exact, split);
  verdict.exact = {};
  live.is_checked = true;
  if (verdict.answer == Judgement::wrong || verdict.answer == Judgement::undecidable)
    live.explanation = verdict.remark;
  constexpr std::size_t kShown = 5;
  for (std::size_t i = 0; i < std::min(kShown, verdict.wrong.size()); ++i)
    live.explanation +=
        (live.explanation.empty() ? "" : "\n") +
        sentence(verdict.wrong[i], descriptions_.trees[(*trees)[0]], descriptions_.trees[(*trees)[1]]);
  if (verdict.wrong.size() > kShown)
    live.explanation += "\n... and " + std::to_string(verdict.wrong.size() - kShown) + " more";
  sums_ += sums_of(live.checked);
}

std::optional<std::uint32_t> LiveQueries::check_one() {
  for (auto query = kept_.rbegin(); query != kept_.rend(); ++query)
    if (!query->is_checked && query->has_events) {
      check(*query);
      --unchecked_;
      return query->query.number;
    }
  return std::nullopt;
}

/// Drops what exceeds the settings: old queries that are not remarkable, old remarkable ones, old events.
void LiveQueries::forget() {
  const auto drop = [&](std::deque<LiveQuery>::iterator query) {
    if (query->has_events) events_ -= query->query.events.size();
    kept_.erase(query);
  };
  if (kept_.size() > settings_.last) {
    const auto last = kept_.end() - static_cast<std::ptrdiff_t>(settings_.last);
    const auto is_plain = [](const LiveQuery& q) { return !q.is_wrong() && !q.is_slow; };
    const auto plain = std::find_if(kept_.begin(), last, is_plain);
    if (plain != last)
      drop(plain);
    else if (kept_.size() > settings_.last + settings_.remarkable)
      drop(kept_.begin());
  }
  for (auto q = kept_.begin(); q != kept_.end() && events_ > settings_.events; ++q) {
    if (!q->has_events) continue;
    events_ -= q->query.events.size();
    q->query.events = {};
    q->query.parts = {};
    q->has_events = false;
  }
}

const LiveQuery* LiveQueries::find(std::uint32_t number) const {
  const auto found =
      std::find_if(kept_.begin(), kept_.end(), [&](const LiveQuery& q) { return q.query.number == number; });
  return found == kept_.end() ? nullptr : &*found;
}

ordered_json LiveQueries::sums_json() const {
  ordered_json out{{"engine", descriptions_.engine}, {"queries", count_}, {"not_checked", unchecked_}};
  for (const auto& entry : kEnumNames<Judgement>)
    out[std::string(entry.name)] = sums_.outcomes[static_cast<std::size_t>(entry.value)];
  out["median_us"] = median_.value() / 1000;
  out["p99_us"] = p99_.value() / 1000;
  out["advice"] = sums_.queries > 0 ? advice(sums_.prices) : "";
  return out;
}

ordered_json LiveQueries::json_of(const LiveQuery& q) const {
  const auto mesh_name = [&](std::uint32_t tree) {
    if (tree == kNull) return std::string("a shape");
    const std::uint32_t mesh = descriptions_.trees[tree].mesh;
    const std::string& name = descriptions_.meshes[mesh].name;
    return name.empty() ? "mesh " + std::to_string(mesh + 1) : name;
  };
  ordered_json out{
      {"number", q.query.number},
      {"kind", name_of(q.query.kind)},
      {"a", mesh_name(q.query.trees[0])},
      {"b", mesh_name(q.query.trees[1])},
      {"answer", name_of(q.query.verdict)},
      {"pairs", q.query.pairs},
      {"us", q.query.duration_ns / 1000},
      {"tests", q.tests},
      {"slow", q.is_slow},
      {"verdict", q.is_checked ? std::string(name_of(q.checked.verdict.outcome)) : "not checked"},
      {"run", q.has_events && q.query.trees[0] != kNull && q.query.trees[1] != kNull}};
  if (!q.is_checked) return out;
  const Prices& p = q.checked.prices;
  out["exact_pairs"] = q.checked.verdict.exact_pairs;
  out["explanation"] = q.explanation;
  out["remark"] = q.checked.verdict.remark;
  out["prices"] = {{"needed", p.needed}, {"proof", p.proof},       {"volumes", p.volumes},
                   {"order", p.order},   {"not split", p.unsplit}, {"unattributed", p.unattributed}};
  out["triangle_tests"] = p.triangle_tests;
  out["for_nothing"] = p.triangle_tests_for_nothing;
  return out;
}

std::string LiveQueries::summary() const {
  using render::group_digits;
  std::string out = render::counted(count_, "query", "queries");
  const char* separator = ": ";
  for (const Judgement j :
       {Judgement::right, Judgement::undecidable, Judgement::wrong, Judgement::unchecked}) {
    std::uint64_t n = sums_.outcomes[static_cast<std::size_t>(j)];
    if (j == Judgement::unchecked) n += unchecked_;
    if (n == 0) continue;
    out += separator + group_digits(n) + " " +
           std::string(j == Judgement::unchecked ? "not checked" : name_of(j));
    separator = ", ";
  }
  if (count_ > 0 && p99_.value() > 1)
    out += "; median " + microseconds(median_.value()) + ", 99 %: " + microseconds(p99_.value());
  return out;
}

capture::Capture LiveQueries::capture_of(const LiveQuery& query) const {
  capture::Capture out = descriptions_;
  out.queries = {query.query};
  out.cut_off = false;
  return out;
}

}  // namespace lrb::profile
