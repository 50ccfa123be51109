#include "bench/stability/stability_report.hpp"

#include <algorithm>
#include <cctype>

#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::stability {

namespace {

/// Returns the share of an outcome in the cases of a difficulty.
double share_of(const Cell& cell, Outcome o, std::size_t difficulty) {
  return static_cast<double>(cell.of(o)[difficulty]) / static_cast<double>(cell.cases(difficulty));
}

/// The failures of each method by difficulty, in percent. The meanings of the lowest and highest difficulty
/// are below the axis.
report::Chart profile(const Grid& grid, std::size_t family) {
  const FamilyRow& row = grid.families[family];
  report::Axis difficulty{"", false, -0.6, kDifficulties - 0.4};
  if (!row.benign.empty() || !row.degenerate.empty())
    difficulty.label = row.benign + " \u2192 " + row.degenerate;
  constexpr std::size_t kEvery = 3;
  for (std::size_t i = 0; i < kDifficulties; i += kEvery)
    difficulty.ticks.push_back({static_cast<double>(i), row.values.empty() ? "" : row.values[i]});
  report::Chart chart{row.name, difficulty, {"failures, %", false, -3, 103}};
  for (std::size_t m = 0; m < grid.methods.size(); ++m) {
    if (!grid.methods[m].present) continue;
    const Cell& cell = grid.at(family, m);
    report::Series s{grid.methods[m].title, {}, {}};
    // Points are shifted sideways so that lines do not hide each other.
    constexpr double kApart = 0.07;
    const double shift = kApart * (static_cast<double>(m) - static_cast<double>(grid.methods.size() - 1) / 2);
    for (std::size_t i = 0; i < kDifficulties; ++i) {
      if (cell.cases(i) == 0) continue;
      s.x.push_back(static_cast<double>(i) + shift);
      s.y.push_back(100 * static_cast<double>(cell.failures(i)) / static_cast<double>(cell.cases(i)));
    }
    chart.series.push_back(std::move(s));
  }
  return chart;
}

/// For each family a chart of failures by difficulty with a line per present method.
report::Gnuplot profile_chart(const Grid& grid) {
  std::vector<report::Chart> panels;
  for (std::size_t f = 0; f < grid.families.size(); ++f) panels.push_back(profile(grid, f));
  return report::gnuplot(panels, {4, 38, 28, 6, "", 2});
}

/// Returns a difficulty, with its parameter if known: "7 of 0 to 10 (4e-13)".
std::string setting_text(const FamilyRow& family, int difficulty) {
  std::string out = std::to_string(difficulty) + " of 0 to " + std::to_string(kDifficulties - 1);
  if (!family.values.empty()) out += " (" + family.values[static_cast<std::size_t>(difficulty)] + ")";
  return out;
}

std::string sentence(const Cell& cell, const FamilyRow& family) {
  std::string out = render::group_digits(cell.failures()) + " of " +
                    render::counted(cell.answered(), "case fails", "cases fail");
  static constexpr const char* kHow[] = {"with a wrong answer", "by a crash", "by a time-out", "refused"};
  for (std::size_t k = 0; k < kNotRight.size(); ++k)
    if (const std::uint64_t n = cell.sum(kNotRight[k]); n > 0)
      out += ", " + render::group_digits(n) + " " + kHow[k];
  if (cell.first_failing() >= 0) out += "; first at difficulty " + setting_text(family, cell.first_failing());
  return out;
}

report::GridCell page_cell(const Cell& cell, const FamilyRow& family, const std::string& where) {
  const std::uint64_t answered = cell.answered();
  report::GridCell out;
  out.level = cell.only_rejected() ? report::GridCell::kOnlyRejected : cell.level();
  out.count = answered > 0 ? render::group_digits(cell.failures()) : "\u2013";
  out.of = answered > 0 ? "of " + render::group_digits(answered) : "all refused";
  for (std::size_t k = 1; k < kNotRight.size(); ++k)
    if (const std::uint64_t n = cell.sum(kNotRight[k]); n > 0) out.marks[k] = render::group_digits(n);
  out.label = where + ": " + sentence(cell, family);
  for (std::size_t i = 0; i < kDifficulties; ++i) {
    out.bars.push_back({-1, 0, 0, 0});
    for (std::size_t k = 0; k < kNotRight.size() && cell.cases(i) > 0; ++k)
      out.bars.back()[k] = share_of(cell, kNotRight[k], i);
  }
  return out;
}

/// Replaces all characters except letters, digits and dashes.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '-';
  return out;
}

std::string to_text(Outcome o) {
  return io::in_words(name_of(o));
}

report::GridDetail page_detail(const Grid& grid, std::size_t f, std::size_t m, const ReportOptions& options) {
  const Record& r = *grid.at(f, m).worst;
  const FamilyRow& family = grid.families[f];
  report::GridDetail d;
  d.id = "case-" + plain(family.name) + "-" + plain(grid.methods[m].name);
  d.title = family.name + " \u00d7 " + grid.methods[m].title;
  d.text = answer_text(r);
  const std::size_t cell = f * grid.methods.size() + m;
  if (cell < options.pictures.size()) d.file = options.pictures[cell];
  const bool answered = r.outcome == Outcome::right || r.outcome == Outcome::wrong;
  d.facts = {{"Outcome", to_text(r.outcome)}};
  if (grid.quantity == Quantity::pairs) {
    d.facts.emplace_back("Intersecting pairs", render::group_digits(r.expected));
    if (answered) {
      d.facts.emplace_back("Missed", render::group_digits(r.missed));
      d.facts.emplace_back("In excess", render::group_digits(r.extra));
    }
    if (!r.expected_relation.empty()) d.facts.emplace_back("Relation", r.expected_relation);
    if (!r.relation.empty()) d.facts.emplace_back("Answered", r.relation);
  } else {
    d.facts.emplace_back("Right", r.expected_relation.empty() ? "\u2013" : r.expected_relation);
    if (answered) d.facts.emplace_back("Answered", r.relation);
  }
  d.facts.emplace_back("Difficulty", setting_text(family, r.difficulty));
  d.facts.emplace_back("Case, seed", render::group_digits(r.case_index) + ", " + std::to_string(r.seed));
  if (answered) d.facts.emplace_back("Query", render::short_number(r.microseconds) + " \u00b5s");
  d.note = "This family, this method: " + sentence(grid.at(f, m), family) + ".";
  if (options.command) d.command = options.command(r);
  if (options.command && grid.quantity == Quantity::pairs)
    d.note +=
        " The command runs this case again; with --minimise --save DIR it shrinks it to a few triangles, and writes a "
        "report.";
  return d;
}

report::Grid page_grid(const Grid& grid, const ReportOptions& options) {
  report::Grid out;
  out.title = "Families of cases \u00d7 methods";
  out.corner = "family, and its difficulty from benign to degenerate";
  out.level_names.assign(kLevelNames.begin(), kLevelNames.end());
  out.part_names = {"wrong answer", "crashed", "timed out", "refused"};
  for (const methods::MethodInfo& m : grid.methods)
    out.columns.push_back({m.name, m.title + ". " + m.remark});
  for (std::size_t f = 0; f < grid.families.size(); ++f) {
    const FamilyRow& family = grid.families[f];
    out.rows.push_back({family.name, family.what, family.benign, family.degenerate, family.values});
    for (std::size_t m = 0; m < grid.methods.size(); ++m) {
      const std::string where = family.name + " \u00d7 " + grid.methods[m].title;
      out.cells.push_back(page_cell(grid.at(f, m), family, where));
      if (!grid.at(f, m).worst) continue;
      out.cells.back().detail = static_cast<int>(out.details.size());
      out.details.push_back(page_detail(grid, f, m, options));
    }
  }
  out.rows.push_back({"all families"});
  out.total_rows = 1;
  for (std::size_t m = 0; m < grid.methods.size(); ++m) {
    const std::string where = "all families \u00d7 " + grid.methods[m].title;
    out.cells.push_back(page_cell(sum_of_column(grid, m), {}, where));
  }
  out.note =
      "In each cell: failures of the cases that were not refused, and below them one bar per difficulty, benign on the left, "
      "degenerate on the right; its height is the share of that difficulty's cases. A click on a cell with failures shows its "
      "worst case; arrow keys then go from case to case.";
  return out;
}

/// Returns the texts of a page about a number (distance, first contact or depth).
std::vector<report::Text> texts_of_numbers(Quantity quantity) {
  const char* query =
      quantity == Quantity::distance ? "The distance between the surfaces of two bodies at two poses."
      : quantity == Quantity::near_pairs
          ? "The pairs of triangles of two bodies whose distance is at most d: 0, the distance of two corners, a billionth or a "
            "tenth of the bodies' size, or their size."
      : quantity == Quantity::self_intersections
          ? "The pairs of triangles in which a mesh of both bodies intersects itself: that share more than the corners and edges "
            "that they share by index."
      : quantity == Quantity::depth
          ? "The penetration depth of two convex bodies: the length of the shortest translation that separates them."
          : "The time of impact, from 0 to 1: B moves in a straight line to its pose and beyond.";
  return {
      {"Query", std::string(query) + " Every method gets the same bodies, in double precision. Families and "
                                     "difficulties are the same as on the page on pairs."},
      {"Verdicts",
       "By rational arithmetic on the same doubles: brute force over all pairs of triangles, or over all separating planes of "
       "convex bodies. An answer is wrong if it reports a false contact or misses one; if a certified interval "
       "does not contain the number; if any other answer has an error of more than a millionth of the bodies' size, or a "
       "thousandth of the motion; or if pairs of a list are missed or in excess. Refused: 2D bodies, bodies of too many faces for rational arithmetic and, for depths, "
       "bodies that are not convex."},
      {"Limits",
       "The cases are made to be hard, and most methods do not promise exact answers. Families are samples: no failure among "
       "them is no proof."},
  };
}

std::vector<report::Text> texts() {
  return {
      {"Query",
       "The intersecting pairs of faces of two bodies at two poses, and the relation of the bodies. Every method gets the same "
       "bodies and poses, in double precision. A family is one known cause of failures, with a difficulty from benign to "
       "degenerate; random numbers are the same at all difficulties."},
      {"Verdicts",
       "Against brute force in exact arithmetic on the same doubles: touching faces intersect, faces with a gap of one unit "
       "in the last place do not. Only what a method claims to report is judged: a case is wrong if pairs are missed or in "
       "excess, or the relation is wrong. Each case runs in a process of its own: crashes and time-outs are failures. "
       "Refusals are counted, but are no failures."},
      {"Limits",
       "The cases are made to be hard: shares show where a method breaks, not how often it would in a game or a robot. Most "
       "methods do not promise exact answers, and some take touching for separate on purpose. Speed is not compared. Families "
       "are samples: no failure among them is no proof."},
  };
}

void check(const Grid& grid) {
  if (grid.cells.size() != grid.families.size() * grid.methods.size())
    throw InputError("stability: " + std::to_string(grid.cells.size()) + " cells for " +
                     std::to_string(grid.families.size()) + " families and " +
                     std::to_string(grid.methods.size()) + " methods");
}

}  // namespace

std::string answer_text(const Record& r) {
  std::string out = to_text(r.outcome);
  if (r.missed + r.extra > 0)
    out += ": " + render::group_digits(r.missed) + " missed, " + render::group_digits(r.extra) + " in excess";
  else if (r.outcome == Outcome::wrong && r.relation != r.expected_relation)
    out += ": " + r.relation + " instead of " + r.expected_relation;
  if (!r.message.empty()) out += ": " + r.message;
  return out;
}

report::Document stability_page(const Grid& whole, const std::string& folder, const ReportOptions& given) {
  check(whole);
  const Grid grid = present_part(whole);
  ReportOptions options = given;
  options.pictures.clear();
  for (std::size_t i = 0; i < given.pictures.size(); ++i)
    if (whole.methods[i % whole.methods.size()].present) options.pictures.push_back(given.pictures[i]);
  std::uint64_t answers = 0;
  for (const Cell& c : grid.cells) answers += c.cases();
  const std::size_t absent = whole.methods.size() - grid.methods.size();
  const bool pairs = grid.quantity == Quantity::pairs;
  report::Document doc(pairs ? "Where collision methods fail"
                             : "Where methods fail: " + io::in_words(name_of(grid.quantity)));
  doc.each(pairs ? texts() : texts_of_numbers(grid.quantity), &report::Document::reading)
      .number({"Families", render::group_digits(grid.families.size()),
               std::to_string(kDifficulties) + " difficulties each"})
      .number(
          {"Methods", render::group_digits(grid.methods.size()),
           absent == 0 ? "all that are known" : render::group_digits(absent) + " more not installed here"})
      .number({"Answers judged", render::group_digits(answers), "one per case and method"})
      .number({"Time of the cases", render::short_number(grid.seconds) + " s"});
  report::Grid shown = page_grid(grid, options);
  shown.missing = absent_text(whole);
  return doc.grid(shown, folder).command(grid.command).each(options.links, &report::Document::link);
}

report::Document write_stability_report(const Grid& grid, const report::Folder& folder,
                                        const ReportOptions& options) {
  report::Document doc = stability_page(grid, folder, options);
  doc.file("grid.csv", csv_of(grid), "the outcomes of each method, family and difficulty");
  if (options.tex)
    doc.file("grid.tex", report::booktabs(table_of(present_part(grid))), "the grid, for LaTeX");
  doc.print("stability-profiles", "failures by difficulty, for print", profile_chart(grid));
  doc.write(folder);
  return doc;
}

}  // namespace lrb::stability
