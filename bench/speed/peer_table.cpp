#include "bench/speed/peer_table.hpp"

#include <cstdarg>
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

std::string mode_name(const PeerTable& t, Mode mode, const char* all, const char* first,
                      const char* number = ", distance: ") {
  return t.quantity != Quantity::pairs ? number : mode == Mode::all_pairs ? all : first;
}

std::vector<Mode> modes_of(Quantity quantity) {
  if (quantity == Quantity::pairs) return {Mode::all_pairs, Mode::first_pair};
  return {Mode::all_pairs};
}

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

/// Returns true if a number is not within a billionth of the size of the right one.
bool is_off(const DataSet& set, const Question& q, const Reply& answer) {
  const double allowed = 1e-9 * set.diagonal;
  return q.number && !(answer.upper.value_or(-1) >= q.number->least - allowed &&
                       answer.lower.value_or(-1) <= q.number->most + allowed);
}

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
    cell.missed += answer.missed + is_off(set, set.questions[q], answer);
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
  const std::string what = mode_name(t, mode, "ALL PAIRS", "FIRST PAIR (boolean)", "DISTANCE");
  report::Table table{
      what + ". lrbscope's time in microseconds, hot; then the others' times relative to it, hot",
      {"bodies", "pose", "pairs", "ours us", "p95"}};
  for (const methods::MethodInfo& m : t.methods)
    if (m.role != Role::ours && m.present) table.columns.push_back(m.name);
  for (const std::string& set : t.sets)
    for (const PoseClass c : t.classes) {
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
  struct Column {
    const char* title;
    Mode mode;
    bool apart;
  };
  std::vector<Column> columns = {{"distance", Mode::all_pairs, false}};
  if (t.quantity == Quantity::pairs)
    columns = {{"all pairs", Mode::all_pairs, false},
               {"boolean", Mode::first_pair, false},
               {"apart", Mode::all_pairs, true}};
  std::vector<std::vector<std::string>> rows(1, {""});
  for (const Column& c : columns) rows[0].insert(rows[0].end(), {c.title, "cold"});
  rows[0].insert(rows[0].end(), {"missed", "extra"});
  for (const methods::MethodInfo& m : t.methods) {
    rows.push_back({m.name});
    if (!m.present) {
      rows.back().push_back("absent: " + m.remark);
      continue;
    }
    for (const auto& [title, mode, apart] : columns)
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
    for (const PoseClass c : t.classes)
      for (const Mode mode : modes_of(t.quantity)) {
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
          out += "    " + set + ", " + info_of(c).title + mode_name(t, mode, ", all pairs: ", ", boolean: ") +
                 peers + "\n";
      }
  if (compared == 0) return "  No other engine was measured.\n";
  if (out.empty()) return text("  No other engine is faster in any of %zu cells, hot or cold.\n", compared);
  return text("CELLS IN WHICH ANOTHER ENGINE IS FASTER (%zu of %zu), and by how much\n", behind, compared) +
         out;
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
  if (!sets.empty()) t.quantity = sets.front().quantity;
  t.classes = {PoseClass::interlocked};
  if (const auto classes = classes_of(t.quantity); t.quantity == Quantity::pairs)
    t.classes.assign(classes.begin(), classes.end());
  for (const DataSet& set : sets) {
    t.sets.push_back(set.name);
    for (const methods::MethodInfo& m : methods)
      for (const PoseClass c : t.classes)
        for (const Mode mode : modes_of(t.quantity))
          if (m.present && (m.pairs || mode == Mode::first_pair))  // a method without a list answers less
            t.cells.push_back(cell_of(set, m.name, ours_name, c, mode, by_key));
  }
  return t;
}

std::string in_brief(const PeerTable& t) {
  std::string out;
  for (const Mode mode : modes_of(t.quantity)) {
    const report::Table table = table_of_ratios(t, mode);
    out += table.title + "\n" + report::in_columns(table, 2) + "\n";
  }
  return out + means_of(t) + ahead_of(t) + "\n";
}

report::Table table_of_cells(const PeerTable& t) {
  report::Table table{"",
                      {"bodies", "pose", "mode", "method", "hot us", "hot p95", "cold us", "cold p95",
                       "x ours", "cold x ours", "pairs", "missed", "extra", "no answer"}};
  for (const PeerCell& c : t.cells) {
    if (c.questions == 0) continue;
    table.rows.push_back(
        {c.set, info_of(c.pose_class).title, mode_name(t, c.mode, "all", "first", "distance"), c.method});
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
