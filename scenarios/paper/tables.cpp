#include "scenarios/paper/tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "scenarios/paper/experiment.hpp"
#include "trace/json_read.hpp"
#include <lrbscope/trace/trace.hpp>

namespace lrb::paper {
namespace {

class SpreadOf {
 public:
  void add(std::uint64_t n) {
    const auto x = static_cast<double>(n);
    min_ = std::min(min_, x);
    max_ = std::max(max_, x);
    sum_ += x;
    ++count_;
  }
  double average() const { return count_ == 0 ? 0 : sum_ / count_; }
  Spread spread() const { return count_ == 0 ? Spread{} : Spread{min_, average(), max_}; }

 private:
  double min_ = std::numeric_limits<double>::infinity(), max_ = 0, sum_ = 0, count_ = 0;
};

RecursionRow count(std::span<const ContactStep> steps, const std::string& object, std::size_t recursion) {
  RecursionRow row;
  SpreadOf comparisons, refinements, bound_tests;
  for (const ContactStep& s : steps) {
    if (s.object != object) continue;
    const RecursionCount& n = s.counts[recursion];
    comparisons.add(n.comparisons);
    refinements.add(n.refinements);
    bound_tests.add(n.bound_tests);
    row.pairs += n.pairs;
    row.missed += n.missed;
  }
  row.comparisons = comparisons.spread();
  row.refinements = refinements.spread();
  row.bound_tests = bound_tests.average();
  return row;
}

}  // namespace

std::vector<ObjectRow> make_table(std::span<const PaperObject> objects, std::span<const ContactStep> steps) {
  std::vector<ObjectRow> rows;
  const double total_a = objects[0].rep.face_count();
  for (const PaperObject& x : objects.subspan(1)) {
    ObjectRow row;
    row.object = x.name;
    row.real_faces = x.rep.real_face_count();
    row.total_faces = x.rep.face_count();
    row.steps = static_cast<std::uint64_t>(
        std::count_if(steps.begin(), steps.end(), [&](const ContactStep& s) { return s.object == x.name; }));
    for (std::size_t i = 0; i < kRecursions.size(); ++i) row.recursions[i] = count(steps, x.name, i);
    row.n_log_n = std::floor(row.total_faces * std::log2(total_a));
    row.n_squared = row.total_faces * total_a;
    rows.push_back(std::move(row));
  }
  return rows;
}

std::span<const PublishedRow> published_table2() {
  static constexpr std::array<PublishedRow, 7> rows = {{{"B", 744, 1229, 1705},
                                                        {"C", 674, 1162, 1848},
                                                        {"D", 709, 1537, 3688},
                                                        {"E", 709, 2257, 4279},
                                                        {"F", 744, 1627, 5395},
                                                        {"G", 744, 1909, 6089},
                                                        {"H", 709, 2682, 5798}}};
  return rows;
}

const PublishedRow* published(const std::string& object) {
  for (const PublishedRow& p : published_table2())
    if (object == p.object) return &p;
  return nullptr;
}

std::string tables_json(std::span<const PaperObject> objects, std::span<const ObjectRow> rows,
                        const PaperProtocol& protocol) {
  nlohmann::ordered_json j;
  j["source"] = "measured by lrbscope paper";
  j["protocol"] = io::record_to_json(protocol);
  for (const PaperObject& o : objects)
    j["table1_object_sizes"][o.name] = {{"real_faces", o.rep.real_face_count()},
                                        {"total_faces", o.rep.face_count()}};
  for (std::size_t i = 0; i < kRecursions.size(); ++i) {
    std::string key = "table2_face_comparisons_of_object_A_with";
    if (kRecursions[i] != Recursion::paper) key += "_" + std::string(trace::name_of(kRecursions[i]));
    for (const ObjectRow& row : rows) {
      const RecursionRow& r = row.recursions[i];
      j[key][row.object] = {{"min", r.comparisons.min},
                            {"avg", r.comparisons.average},
                            {"max", r.comparisons.max},
                            {"n_log_n", row.n_log_n},
                            {"n_squared", row.n_squared},
                            {"refinements_avg", r.refinements.average},
                            {"refinements_max", r.refinements.max},
                            {"bound_tests_avg", r.bound_tests},
                            {"pairs", r.pairs},
                            {"missed", r.missed},
                            {"steps", row.steps}};
    }
  }
  return j.dump(2) + "\n";
}

}  // namespace lrb::paper
