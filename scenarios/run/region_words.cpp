#include "scenarios/run/region_words.hpp"

#include <algorithm>
#include <set>

#include "render/overlay.hpp"

namespace lrb::run {
namespace {

std::string number_and(std::size_t n, const char* what) {
  return render::group_digits(n) + " " + what + (n == 1 ? "" : "s");
}

/// Returns the first few regions of a set, by their numbers.
std::string list_of(const std::set<std::uint32_t>& regions) {
  constexpr std::size_t kMost = 6;
  std::string out;
  std::size_t count = 0;
  for (const std::uint32_t r : regions) {
    if (count++ == kMost) return out + ", ...";
    out += (out.empty() ? "" : ", ") + std::to_string(r);
  }
  return out;
}

std::string words_of_one(const LrbRep& rep, RegionId r, const std::string& owner) {
  std::set<std::uint32_t> outside, inside;
  for (const FaceId f : rep.lids(r))
    if (is_region(rep.outer_cell(f)) && rep.outer_cell(f) != rep.parent(r)) outside.insert(rep.outer_cell(f));
  std::size_t real = 0;
  for (const FaceId f : rep.floor(r)) {
    real += rep.is_real(f);
    if (is_region(rep.inner_cell(f))) inside.insert(rep.inner_cell(f));
  }
  std::string out = "region " + std::to_string(r) + owner + ": layer " + std::to_string(rep.layer(r)) + ", " +
                    number_and(rep.lids(r).size(), "lid") + " over " +
                    number_and(rep.floor(r).size(), "face");
  if (real > 0) out += ", " + render::group_digits(real) + " of them real";
  out += "; parent " + (is_region(rep.parent(r)) ? std::to_string(rep.parent(r)) : "the outside");
  if (!outside.empty()) out += "; also under " + list_of(outside);
  if (!inside.empty()) out += "; hides " + list_of(inside);
  return out;
}

}  // namespace

std::string region_words(const LrbRep& rep, std::span<const RegionId> regions, const std::string& owner) {
  if (regions.size() == 1) return words_of_one(rep, regions[0], owner);
  std::size_t lids = 0, floor = 0;
  std::set<std::uint32_t> layers, numbers;
  for (const RegionId r : regions) {
    lids += rep.lids(r).size();
    floor += rep.floor(r).size();
    layers.insert(rep.layer(r));
    numbers.insert(r);
  }
  return number_and(regions.size(), "region") + owner + " (" + list_of(numbers) + "): layer" +
         (layers.size() == 1 ? " " : "s ") + list_of(layers) + ", " + number_and(lids, "lid") + " over " +
         number_and(floor, "face");
}

}  // namespace lrb::run
