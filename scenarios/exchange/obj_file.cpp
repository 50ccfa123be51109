#include <cstdint>

#include "scenarios/exchange/model_files.hpp"
#include "scenarios/io/number_text.hpp"

namespace lrb::exchange {
namespace {

/// Appends a part as an object; `first` is the number of its first vertex, from 1.
void write_part(std::string& out, const Part& part, std::size_t first) {
  out += "o " + part.name + "\n";
  for (const Eigen::Vector3d& x : part.vertices)
    out += "v " + io::exact_text(x.x()) + " " + io::exact_text(x.y()) + " " + io::exact_text(x.z()) + "\n";
  constexpr char kWord[] = {'p', 'l', 'f'};
  for (std::size_t c = 0; c < part.cell_count(); ++c) {
    out += kWord[static_cast<std::size_t>(part.shape)];
    for (const std::uint32_t v : part.cell(c)) out += " " + std::to_string(first + v);
    out += "\n";
  }
}

}  // namespace

std::string obj_bytes(const Model& model, const FileOptions& options) {
  std::string out = "# " + model.title + "\n";
  std::size_t first = 1;
  const std::vector<Part> split = options.regions ? split_by_region(model) : std::vector<Part>();
  for (const Part& part : options.regions ? split : model.parts) {
    write_part(out, part, first);
    first += part.vertices.size();
  }
  return out;
}

}  // namespace lrb::exchange
