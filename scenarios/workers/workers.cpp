#include "scenarios/workers/workers.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "scenarios/workers/child.hpp"
#include "scenarios/workers/method_json.hpp"

namespace lrb::workers {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kProgram = "lrbscope-methods";  // and programs whose names begin with it
constexpr std::chrono::seconds kListLimit(20);

fs::path folder_of_workers() {
  if (const char* given = std::getenv("LRBSCOPE_METHODS")) return given;
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path(".") : self.parent_path();
}

/// Returns the workers' programs in the order of their names.
std::vector<fs::path> programs_in(const fs::path& folder) {
  std::vector<fs::path> programs;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const bool is_ours = name.starts_with(kProgram) &&
                         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos;
    if (is_ours && entry.is_regular_file(error) && access(entry.path().c_str(), X_OK) == 0)
      programs.push_back(entry.path());
  }
  std::sort(programs.begin(), programs.end());
  return programs;
}

[[noreturn]] void throw_not_found(const std::string& program) {
  throw EnvironmentError(printable_name(program) +
                         ": not found; it is built beside lrbscope and not installed: build it (cmake "
                         "--build --preset release --target lrbscope-workers) and run lrbscope from its "
                         "build folder, or name that in LRBSCOPE_METHODS");
}

}  // namespace

std::vector<WorkerMethod> methods_of(const std::string& program, const std::vector<std::string>& options) {
  std::vector<std::string> command = {program, "--list"};
  command.insert(command.end(), options.begin(), options.end());
  const std::vector<std::string> lines = lines_of(command, kListLimit);
  std::vector<WorkerMethod> methods;
  for (const std::string& line : lines) {
    const auto value = nlohmann::json::parse(line, nullptr, false);
    if (!value.is_object()) break;
    WorkerMethod m;
    m.info = method_info_from(value);
    m.column = {m.info.name, m.info.title, m.info.remark, m.info.present};
    m.program = program;
    methods.push_back(m);
  }
  if (lines.empty())
    throw EnvironmentError(printable_name(program) + ": did not say which methods it has; build it again");
  return methods;
}

std::vector<WorkerMethod> find_methods() {
  std::vector<WorkerMethod> methods = find_all_methods();
  std::erase_if(methods, [](const WorkerMethod& m) { return !m.info.hard_cases; });
  return methods;
}

std::vector<WorkerMethod> find_all_methods() {
  const fs::path folder = folder_of_workers();
  std::vector<WorkerMethod> methods;
  for (const fs::path& program : programs_in(folder))
    for (WorkerMethod& m : methods_of(program.string())) methods.push_back(std::move(m));
  if (methods.empty()) throw_not_found((folder / kProgram).string());
  return methods;
}

std::vector<WorkerMethod> find_number_methods(methods::Quantity quantity) {
  return methods_of(number_worker(), {"--quantity", std::string(name_of(quantity))});
}

std::string number_worker() {
  std::string program = program_beside("lrbscope-quantities");
  if (program.empty()) throw_not_found("lrbscope-quantities");
  return program;
}

std::string program_beside(const std::string& name) {
  const std::string path = (folder_of_workers() / name).string();
  return access(path.c_str(), X_OK) == 0 ? path : "";
}

}  // namespace lrb::workers
