#include "scenarios/stability/report/worst_pictures.hpp"

#include <filesystem>

#include "engine/core/atomic_file.hpp"
#include "engine/core/error.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/stability/report/stability_report.hpp"
#include "scenarios/stability/report/worst_case.hpp"

namespace lrb::stability {
namespace {

constexpr const char* kFolder = "worst";

void remove_old_pictures(const std::string& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".png") std::filesystem::remove(entry.path(), error);
}

WorstCaseText text_of(const Record& r, const std::string& method) {
  WorstCaseText text;
  text.title = r.family + " \u00d7 " + method;
  text.answer = answer_text(r);
  text.counters = {{"dial", std::to_string(r.dial) + " of 0 to " + std::to_string(cases::kDialSettings - 1)},
                   {"case", std::to_string(r.case_index)}};
  if (!r.expected_relation.empty()) text.counters.push_back({"relation", r.expected_relation});
  if (!r.relation.empty()) text.counters.push_back({"answered", r.relation});
  return text;
}

}  // namespace

std::vector<std::string> draw_worst_cases(
    const Grid& grid, const std::string& folder, const std::function<AnsweredPairs(const Record&)>& ask,
    const std::function<void(std::size_t done, std::size_t total)>& progress) {
  std::vector<std::string> pictures(grid.cells.size());
  std::size_t total = 0, done = 0;
  for (const Cell& c : grid.cells) total += c.worst ? 1 : 0;
  remove_old_pictures(folder + "/" + kFolder);
  if (total == 0) return pictures;
  make_folder(folder + "/" + kFolder);
  render::Rasterizer rasterizer;
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (!grid.cells[i].worst) continue;
    if (progress) progress(done++, total);
    const Record& r = *grid.cells[i].worst;
    const cases::Family* family = cases::find_family(r.family);
    if (family == nullptr) continue;
    const workers::MethodColumn& method = grid.methods[i % grid.methods.size()];
    const std::string file = std::string(kFolder) + "/" + r.family + "-" + method.name + ".png";
    const AnsweredPairs pairs = ask(r);
    try {
      draw_worst_case(cases::make_case(*family, r.seed, r.dial, r.case_index), pairs.expected, pairs.answered,
                      text_of(r, method.title), folder + "/" + file, rasterizer);
      pictures[i] = file;
    } catch (const InputError&) {
      // Coordinates that are not finite have no place in a picture; the record says what was asked.
    }
  }
  return pictures;
}

}  // namespace lrb::stability
