#include "scenarios/paper/tables.hpp"

#include <iterator>
#include <limits>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "scenarios/bodies/generators.hpp"
#include "scenarios/paper/experiment.hpp"
#include "scenarios/report/document.hpp"
#include "trace/json_records.hpp"

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
  SpreadOf comparisons, triangles, refinements, bound_tests;
  for (const ContactStep& s : steps) {
    if (s.object != object) continue;
    const RecursionCount& n = s.counts[recursion];
    comparisons.add(n.comparisons);
    triangles.add(n.triangles);
    refinements.add(n.refinements);
    bound_tests.add(n.bound_tests);
    row.pairs += n.pairs;
    row.missed += n.missed;
  }
  row.comparisons = comparisons.spread();
  row.triangles = triangles.spread();
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

bool as_published(std::span<const PaperObject> objects) {
  const auto published = generators::paper_objects();
  return std::all_of(objects.begin(), objects.end(), [&](const PaperObject& o) {
    return std::any_of(published.begin(), published.end(), [&](const generators::FractalSpec& p) {
      return p.name == o.name && p.real_faces == o.rep.real_face_count() &&
             p.total_faces == o.rep.face_count();
    });
  });
}

std::vector<Run> runs_of_seeds(std::span<const PaperObject> objects, std::span<const ContactStep> steps,
                               const PaperProtocol& protocol) {
  std::map<std::uint64_t, std::vector<ContactStep>> by_seed;
  for (const ContactStep& s : steps) by_seed[s.seed].push_back(s);
  std::vector<Run> runs;
  for (std::uint32_t i = 0; i < protocol.seeds; ++i) {
    PaperProtocol p = protocol;
    p.seed += i;
    runs.push_back({p, make_table(objects, by_seed[p.seed])});
  }
  return runs;
}

std::vector<Run> runs_of_settings(std::span<const PaperObject> objects, std::span<const ContactStep> steps,
                                  const PaperProtocol& protocol) {
  std::vector<Run> runs;
  for (PaperProtocol p : other_settings(protocol)) {
    const std::set<std::uint32_t> numbers = {protocol.steps_after / 2, protocol.steps_after, p.steps_after};
    for (const std::uint32_t steps_after : numbers) {
      p.steps_after = steps_after;
      std::vector<ContactStep> counted;
      std::copy_if(steps.begin(), steps.end(), std::back_inserter(counted),
                   [&](const ContactStep& s) { return s.time_step == p.step && s.step <= steps_after; });
      runs.push_back({p, make_table(objects, counted)});
    }
  }
  return runs;
}

Band band_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {(values[(n - 1) / 2] + values[n / 2]) / 2, values.front(), values.back()};
}

namespace {

std::string text_of(double x) {
  return nlohmann::json(x).dump();
}

}  // namespace

RatioBands ratios(std::span<const Run> runs, const std::string& object) {
  RatioBands bands;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    std::vector<double> values;
    for (const Run& run : runs)
      for (const ObjectRow& row : run.rows)
        if (const PublishedRow* p = published(row.object); p && (object.empty() || row.object == object))
          values.push_back(row.recursions[kPaper].comparisons.*kMeasured[i] / p->*kPublished[i]);
    bands[i] = band_of(std::move(values));
  }
  return bands;
}

std::string table1_csv(std::span<const PaperObject> objects) {
  report::Table t{"", {"object", "real_faces", "total_faces", "outermost_faces"}};
  for (const PaperObject& o : objects)
    t.rows.push_back({o.name, std::to_string(o.rep.real_face_count()), std::to_string(o.rep.face_count()),
                      std::to_string(o.rep.outermost_faces().size())});
  return report::csv(t);
}

std::string table2_csv(std::span<const Run> runs) {
  report::Table t{"",
                  {"seed", "time_step", "steps_after", "object", "recursion", "steps", "minimum", "average",
                   "maximum", "published_minimum", "published_average", "published_maximum"}};
  for (const Run& run : runs)
    for (const ObjectRow& row : run.rows)
      for (std::size_t i = 0; i < kRecursions.size(); ++i) {
        std::vector<std::string>& cells = t.rows.emplace_back();
        cells = {std::to_string(run.protocol.seed),           text_of(run.protocol.step),
                 std::to_string(run.protocol.steps_after),    row.object,
                 std::string(trace::name_of(kRecursions[i])), std::to_string(row.steps)};
        for (const auto member : kMeasured) cells.push_back(text_of(row.recursions[i].comparisons.*member));
        const PublishedRow* p = i == kPaper ? published(row.object) : nullptr;
        for (const auto member : kPublished) cells.push_back(p ? text_of(p->*member) : "");
      }
  return report::csv(t);
}

std::string tables_json(std::span<const PaperObject> objects, std::span<const Run> runs,
                        const PaperProtocol& protocol) {
  const std::vector<ObjectRow> rows = runs.empty() ? std::vector<ObjectRow>() : runs.front().rows;
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
  if (as_published(objects))
    for (const ObjectRow& row : rows) {
      const RatioBands bands = ratios(runs, row.object);
      for (std::size_t i = 0; i < bands.size(); ++i)
        j["ratio_to_published"][row.object][kRatioNames[i]] = {
            {"median", bands[i].median}, {"lowest", bands[i].low}, {"highest", bands[i].high}};
    }
  return j.dump(2) + "\n";
}

}  // namespace lrb::paper
