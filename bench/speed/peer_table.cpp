#include "bench/speed/peer_table.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <fstream>
#include <map>
#include <thread>
#include <tuple>

#include "bench/speed/metrics.hpp"

namespace lrb::speed {

std::string machine() {
  std::ifstream in("/proc/cpuinfo");
  std::string model = "unknown processor";
  for (std::string line; std::getline(in, line);)
    if (const std::size_t colon = line.find(": ");
        colon != std::string::npos && line.rfind("model name", 0) == 0) {
      model = line.substr(colon + 2);
      break;
    }
  const unsigned cores = std::thread::hardware_concurrency();
  return std::to_string(cores) + (cores == 1 ? " core, " : " cores, ") + model;
}

std::string build_flags() {
#ifdef __clang__
  return "clang " __clang_version__ ", " LRB_FLAGS;
#else
  return "gcc " __VERSION__ ", " LRB_FLAGS;
#endif
}

namespace {

using methods::Role;

constexpr Mode kModes[] = {Mode::all_pairs, Mode::first_pair};

const Reply& reply(const Record& r, Mode mode) {
  return mode == Mode::all_pairs ? r.all : r.first;
}

[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...) {
  char buffer[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  return buffer;
}

bool is_peer(const methods::MethodInfo& m) {
  return m.role == Role::peer || m.role == Role::aim;
}

/// Returns the name of the method with a role, or "" if the method is missing.
std::string method_in(const std::vector<methods::MethodInfo>& methods, Role role) {
  for (const methods::MethodInfo& m : methods)
    if (m.role == role) return m.name;
  return "";
}

using Key = std::tuple<std::string, std::string, std::uint64_t>;

PeerCell cell_of(const DataSet& set, const std::string& method, const std::string& ours_name, PoseClass c,
                 Mode mode, const std::map<Key, const Record*>& by_key) {
  PeerCell cell;
  cell.set = set.name;
  cell.method = method;
  cell.pose_class = c;
  cell.mode = mode;
  std::vector<double> hot, cold, ratios, cold_ratios;
  for (std::uint64_t q = 0; q < set.questions.size(); ++q) {
    if (set.questions[q].pose_class != c) continue;
    ++cell.questions;
    const auto it = by_key.find({set.name, method, q});
    if (it == by_key.end()) continue;
    const Record& r = *it->second;
    cell.crashed += r.outcome == Outcome::crashed;
    cell.timed_out += r.outcome == Outcome::timed_out;
    if (r.outcome != Outcome::answered) continue;
    ++cell.answered;
    const Reply& answer = reply(r, mode);
    hot.push_back(answer.hot_us);
    cold.push_back(answer.cold_us);
    cell.pairs += static_cast<double>(answer.count);
    cell.missed += answer.missed;
    cell.extra += answer.extra;
    const auto ours = by_key.find({set.name, ours_name, q});
    if (ours == by_key.end() || ours->second->outcome != Outcome::answered) continue;
    ratios.push_back(answer.hot_us / reply(*ours->second, mode).hot_us);
    cold_ratios.push_back(answer.cold_us / reply(*ours->second, mode).cold_us);
  }
  if (cell.answered > 0) cell.pairs /= static_cast<double>(cell.answered);
  cell.hot = median(hot);
  cell.hot_p95 = quantile(hot, 0.95);
  cell.cold = median(cold);
  cell.cold_p95 = quantile(cold, 0.95);
  cell.ratio = median(ratios);
  cell.cold_ratio = median(cold_ratios);
  return cell;
}

std::string ratio_text(const PeerCell* c, double ratio) {
  if (c == nullptr) return "-";
  if (c->answered < c->questions) return c->crashed > 0 ? "crash" : c->timed_out > 0 ? "time-out" : "refused";
  return text(ratio < 9.95 ? "%.2f" : "%.0f", ratio);
}

}  // namespace

report::Table table_of_ratios(const PeerTable& t, Mode mode) {
  report::Table table{mode == Mode::all_pairs ? "ALL PAIRS. lrbscope's time in microseconds, hot; then the "
                                                "others' times relative to it, hot"
                                              : "FIRST PAIR (boolean). As above",
                      {"bodies", "pose", "pairs", "ours us", "p95"}};
  for (const methods::MethodInfo& m : t.methods)
    if (m.role != Role::ours && m.present) table.columns.push_back(m.name);
  for (const std::string& set : t.sets)
    for (const PoseClass c : classes_of(Quantity::pairs)) {
      const PeerCell* ours = t.find(set, method_in(t.methods, Role::ours), c, mode);
      if (ours == nullptr || ours->questions == 0) continue;
      table.rows.push_back({set, info_of(c).title, text("%.0f", ours->pairs), text("%.1f", ours->hot),
                            text("%.1f", ours->hot_p95)});
      for (const methods::MethodInfo& m : t.methods) {
        if (m.role == Role::ours || !m.present) continue;
        const PeerCell* cell = t.find(set, m.name, c, mode);
        table.rows.back().push_back(ratio_text(cell, cell == nullptr ? 0 : cell->ratio));
      }
    }
  return table;
}

namespace {

/// Returns the geometric mean of a method's ratios over data sets and classes of poses.
double mean_ratio(const PeerTable& t, const std::string& method, Mode mode, bool apart, bool cold) {
  std::vector<double> ratios;
  for (const PeerCell& c : t.cells)
    if (c.method == method && c.mode == mode && (c.pose_class == PoseClass::apart) == apart && c.ratio > 0)
      ratios.push_back(cold ? c.cold_ratio : c.ratio);
  return geometric_mean(ratios);
}

std::string means_of(const PeerTable& t) {
  std::vector<std::vector<std::string>> rows = {
      {"", "all pairs", "cold", "boolean", "cold", "apart", "cold", "missed", "extra"}};
  for (const methods::MethodInfo& m : t.methods) {
    rows.push_back({m.name});
    if (!m.present) {
      rows.back().push_back("absent: " + m.remark);
      continue;
    }
    for (const auto& [mode, apart] : {std::pair{Mode::all_pairs, false}, std::pair{Mode::first_pair, false},
                                      std::pair{Mode::all_pairs, true}})
      for (const bool cold : {false, true}) {
        const Mode compared = apart && !m.pairs ? Mode::first_pair : mode;
        const double mean = mean_ratio(t, m.name, compared, apart, cold);
        rows.back().push_back(mean > 0 ? text("%.2f", mean) : "-");
      }
    std::uint64_t missed = 0, extra = 0;
    for (const PeerCell& c : t.cells)
      if (c.method == m.name && c.mode == (m.pairs ? Mode::all_pairs : Mode::first_pair)) {
        missed += c.missed;
        extra += c.extra;
      }
    for (const std::uint64_t n : {missed, extra}) rows.back().push_back(std::to_string(n));
    rows.back().emplace_back(missed + extra > 0 ? "not exact"
                             : m.pairs          ? "exact here"
                                                : "right here (yes or no)");
  }
  return "GEOMETRIC MEANS of the ratios over bodies and classes of poses\n" + report::in_columns(rows) + "\n";
}

/// Lists, by class of poses and mode, all other engines that are faster somewhere, with the maximum factor:
/// "2.1x (cold 1.3x)".
std::string ahead_of(const PeerTable& t) {
  std::string out;
  std::size_t compared = 0, behind = 0;
  for (const std::string& set : t.sets)
    for (const PoseClass c : classes_of(Quantity::pairs))
      for (const Mode mode : kModes) {
        std::string peers;
        for (const methods::MethodInfo& m : t.methods) {
          const PeerCell* cell = t.find(set, m.name, c, mode);
          if (!is_peer(m) || cell == nullptr || cell->ratio <= 0) continue;
          ++compared;
          if (cell->ratio >= 1 && cell->cold_ratio >= 1) continue;
          ++behind;
          peers += peers.empty() ? "" : "; ";
          peers += m.name;
          if (cell->ratio < 1) peers += text(" %.2fx", 1 / cell->ratio);
          if (cell->cold_ratio < 1) peers += text(" cold %.2fx", 1 / cell->cold_ratio);
          if (cell->missed + cell->extra > 0) peers += ", not exact";
        }
        if (!peers.empty())
          out += "    " + set + ", " + info_of(c).title +
                 (mode == Mode::all_pairs ? ", all pairs: " : ", boolean: ") + peers + "\n";
      }
  if (compared == 0) return "  No other engine was measured.\n";
  if (out.empty()) return text("  No other engine is faster in any of %zu cells, hot or cold.\n", compared);
  return text("CELLS IN WHICH ANOTHER ENGINE IS FASTER (%zu of %zu), and by how much\n", behind, compared) +
         out;
}

std::string targets_of(const PeerTable& t) {
  const std::string fcl = method_in(t.methods, Role::aim);
  std::string out = "AIMED AT, against FCL compiled with our flags, hot\n";
  const auto is_present = [&](const methods::MethodInfo& m) { return m.name == fcl && m.present; };
  const std::string why = fcl.empty() ? "the method is not among those of --method"
                          : std::any_of(t.methods.begin(), t.methods.end(), is_present) ? "no such poses"
                                                                                        : "FCL is absent";
  const auto line = [&](const char* what, double reached, double aim) {
    out += reached <= 0 ? text("  %-42s not measured: %s\n", what, why.c_str())
                        : text("  %-42s %.2fx, aim %.0fx: %s\n", what, reached, aim,
                               reached >= aim ? "reached" : "NOT reached");
  };
  line("all pairs, intersecting bodies", mean_ratio(t, fcl, Mode::all_pairs, false, false), 6);
  line("boolean, intersecting bodies", mean_ratio(t, fcl, Mode::first_pair, false, false), 6);
  line("0.5 % apart", mean_ratio(t, fcl, Mode::all_pairs, true, false), 4);
  return out + ahead_of(t) + "\n";
}

std::string price_of(const PeerTable& t) {
  std::vector<double> ordinary;
  std::string identical;
  const std::string in_doubles = method_in(t.methods, Role::ours_double);
  for (const PeerCell& c : t.cells) {
    if (c.method != in_doubles || c.ratio <= 0) continue;
    if (c.pose_class != PoseClass::identical)
      ordinary.push_back(1 / c.ratio);
    else if (c.mode == Mode::all_pairs)
      identical += text("%s%.2f", identical.empty() ? "" : ", ", 1 / c.ratio);
  }
  if (ordinary.empty()) return "";
  return text(
      "COST OF EXACTNESS: %.3f times the time without the exact fallback on ordinary poses (geometric mean; "
      "aim: at most 1.10);\n  identical poses, all pairs: %s\n",
      geometric_mean(ordinary), identical.c_str());
}

}  // namespace

const PeerCell* PeerTable::find(const std::string& set, const std::string& method, PoseClass c,
                                Mode mode) const {
  for (const PeerCell& cell : cells)
    if (cell.set == set && cell.method == method && cell.pose_class == c && cell.mode == mode) return &cell;
  return nullptr;
}

PeerTable peer_table(const std::vector<DataSet>& sets, const std::vector<methods::MethodInfo>& methods,
                     const std::vector<Record>& records) {
  std::map<Key, const Record*> by_key;
  for (const Record& r : records) by_key[{r.set, name_of(r), r.question}] = &r;
  const std::string ours_name = method_in(methods, Role::ours);
  PeerTable t;
  t.methods = methods;
  for (const DataSet& set : sets) {
    t.sets.push_back(set.name);
    for (const methods::MethodInfo& m : methods)
      for (const PoseClass c : classes_of(Quantity::pairs))
        for (const Mode mode : kModes)
          if (m.present && (m.pairs || mode == Mode::first_pair))  // a method without a list answers less
            t.cells.push_back(cell_of(set, m.name, ours_name, c, mode, by_key));
  }
  return t;
}

std::string in_brief(const PeerTable& t) {
  std::string out;
  for (const Mode mode : kModes) {
    const report::Table table = table_of_ratios(t, mode);
    out += table.title + "\n" + report::in_columns(table, 2) + "\n";
  }
  return out + means_of(t) + targets_of(t) + price_of(t);
}

report::Table table_of_cells(const PeerTable& t) {
  report::Table table{"",
                      {"bodies", "pose", "mode", "method", "hot us", "hot p95", "cold us", "cold p95",
                       "x ours", "cold x ours", "pairs", "missed", "extra", "no answer"}};
  for (const PeerCell& c : t.cells) {
    if (c.questions == 0) continue;
    table.rows.push_back(
        {c.set, info_of(c.pose_class).title, c.mode == Mode::all_pairs ? "all" : "first", c.method});
    std::vector<std::string>& row = table.rows.back();
    if (c.answered > 0) {
      for (const double x : {c.hot, c.hot_p95, c.cold, c.cold_p95}) row.push_back(text("%.1f", x));
      for (const double x : {c.ratio, c.cold_ratio}) row.push_back(text("%.2f", x));
      row.push_back(text("%.1f", c.pairs));
      for (const std::uint64_t n : {c.missed, c.extra}) row.push_back(std::to_string(n));
    }
    row.resize(table.columns.size());
    if (c.answered < c.questions)
      row.back() = text("%zu of %zu answered, %zu crashed, %zu timed out", c.answered, c.questions, c.crashed,
                        c.timed_out);
  }
  return table;
}

}  // namespace lrb::speed
