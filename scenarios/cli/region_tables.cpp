#include "scenarios/cli/region_tables.hpp"

#include <cmath>
#include <iomanip>
#include <sstream>

#include "render/overlay.hpp"
#include "scenarios/cli/command.hpp"

namespace lrb::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kRegionDigits = 3;

}  // namespace

nlohmann::ordered_json regions_json(std::span<const bodies::RegionFigures> regions) {
  Json out = Json::array();
  for (const bodies::RegionFigures& r : regions)
    out.push_back({{"region", r.region.value()},
                   {"layer", r.layer},
                   {"lids", r.lids},
                   {"floor", r.floor},
                   {"volume", r.volume},
                   {"distance", std::isfinite(r.thickness) ? Json(r.thickness) : Json(nullptr)},
                   {"parent", is_region(r.parent) ? Json(r.parent.value()) : Json("outside")},
                   {"waste", r.waste}});
  return out;
}

std::string regions_text(const Json& regions) {
  constexpr std::size_t kMostRows = 25;
  constexpr int kWidth = 11;
  std::ostringstream out;
  out << "regions:\n";
  for (const char* title : {"region", "layer", "lids", "floor", "volume", "distance", "parent", "waste"})
    out << std::setw(kWidth) << title;
  out << "\n";
  for (std::size_t i = 0; i < std::min(regions.size(), kMostRows); ++i) {
    for (const auto& [key, value] : regions[i].items())
      out << std::setw(kWidth) << (value.is_null() ? "-" : for_people(value, kRegionDigits));
    out << "\n";
  }
  if (regions.size() > kMostRows)
    out << "  and " << regions.size() - kMostRows << " more: --json lists all\n";
  return out.str() +
         "(distance: no point of its lids is further from the body. waste: floor faces that it opens for nothing, "
         "for each point thrown into the outermost wrapper: its share of the wrapper's volume times its floor; over all regions " +
         bodies::kUsualWaste + ".)\n";
}

Json trials_json(std::span<const bodies::Trial> trials) {
  Json out = Json::array();
  for (const bodies::Trial& t : trials)
    out.push_back({{"setting", t.setting.empty() ? "as it is" : t.setting},
                   {"total_per_real", t.figures.total_per_real},
                   {"outer_faces", t.figures.outer_faces},
                   {"outer_per_hull", t.figures.outer_per_hull},
                   {"waste", t.figures.waste},
                   {"seconds", t.setting.empty() ? Json(nullptr) : Json(t.figures.seconds)}});
  return out;
}

std::string trials_text(const Json& trials) {
  constexpr int kName = 20, kWidth = 20;
  std::ostringstream out;
  out << "tried:\n" << std::left << std::setw(kName) << "  setting" << std::right;
  for (const char* title :
       {"faces per real face", "outermost faces", "wrapper over hull", "waste", "seconds"})
    out << std::setw(kWidth) << title;
  out << "\n";
  for (const Json& t : trials)
    for (const auto& [key, value] : t.items()) {
      if (key == "setting")
        out << "  " << std::left << std::setw(kName - 2) << value.get<std::string>() << std::right;
      else
        out << std::setw(kWidth) << (value.is_null() ? "-" : for_people(value, kRegionDigits));
      if (key == "seconds") out << "\n";
    }
  return out.str();
}

std::string region_caption(const bodies::RegionFigures& r) {
  const auto plural = [](std::uint32_t n, const char* what) {
    return render::group_digits(n) + " " + what + (n == 1 ? "" : "s");
  };
  return "region " + std::to_string(r.region) + ", layer " + std::to_string(r.layer) + ": " +
         plural(r.lids, "lid") + " over " + plural(r.floor, "face") + ", off by " +
         (std::isfinite(r.thickness) ? for_people(r.thickness, kRegionDigits) : "no bound") + "; parent " +
         (is_region(r.parent) ? std::to_string(r.parent) : "outside") + ", waste " +
         for_people(r.waste, kRegionDigits);
}

}  // namespace lrb::cli
