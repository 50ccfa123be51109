#include "scenarios/exchange/model.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace lrb::exchange {
namespace {

/// Returns the part with these of its cells, and of its vertices those that they use, in their order.
Part some_cells(const Part& part, std::span<const std::size_t> cells) {
  constexpr std::uint32_t kUnused = ~0U;
  std::vector<std::uint32_t> number(part.vertices.size(), kUnused);
  for (const std::size_t c : cells)
    for (const std::uint32_t v : part.cell(c)) number[v] = 0;
  Part out;
  out.shape = part.shape;
  out.values.resize(part.values.size());
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kUnused) continue;
    number[v] = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.push_back(part.vertices[v]);
  }
  std::vector<std::uint32_t> corners;
  std::vector<double> row(part.values.size());
  for (const std::size_t c : cells) {
    corners.clear();
    for (const std::uint32_t v : part.cell(c)) corners.push_back(number[v]);
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = part.values[i][c];
    out.add_cell(corners, part.colours[c], row);
  }
  return out;
}

}  // namespace

void Part::add_cell(std::span<const std::uint32_t> at, render::Rgba colour, std::span<const double> row) {
  corners.insert(corners.end(), at.begin(), at.end());
  offsets.push_back(static_cast<std::uint32_t>(corners.size()));
  colours.push_back(colour);
  values.resize(row.size());
  for (std::size_t i = 0; i < row.size(); ++i) values[i].push_back(row[i]);
}

std::size_t Model::column(std::string_view name) const {
  const auto at =
      std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
  if (at == columns.end()) throw std::logic_error("a model without the column " + std::string(name));
  return static_cast<std::size_t>(at - columns.begin());
}

std::vector<Part> split_by_region(const Model& model) {
  std::vector<Part> out;
  for (const Part& part : model.parts) {
    if (!part.in_regions) {
      out.push_back(part);
      continue;
    }
    const std::vector<double>& region = part.values[model.column("region")];
    std::map<double, std::vector<std::size_t>> cells;
    for (std::size_t c = 0; c < part.cell_count(); ++c) cells[region[c]].push_back(c);
    for (const auto& [number, of_region] : cells) {
      out.push_back(some_cells(part, of_region));
      out.back().name =
          part.name +
          (number < 0 ? "_no_region" : "_region_" + std::to_string(static_cast<std::uint64_t>(number)));
    }
  }
  return out;
}

}  // namespace lrb::exchange
