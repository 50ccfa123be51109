#pragma once
/// The pages of answers about one body: distances of points, and self-intersections (report/web/answers.js).

#include <string>

#include "render/pictures/marks.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/self_intersections.hpp>

namespace lrb::run {

/// Write a page with a view of the body and the answers, and a table of them. A row, a point or a segment
/// selects its answer. `command`: the command that made it.
void write_page(const report::Folder& folder, const LrbRep& body, const ShownPoints& points,
                const std::string& command);
/// Shows the first kMaxPairsOfPage pairs.
void write_page(const report::Folder& folder, const LrbRep& body, const SelfIntersections& found,
                const std::string& command);

inline constexpr std::size_t kMaxPairsOfPage = 2000;

}  // namespace lrb::run
