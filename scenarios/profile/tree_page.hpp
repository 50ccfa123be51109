#pragma once
/// A page about a captured tree: figures, charts, an icicle of its nodes, and a 3D view of the body with the
/// volume and the triangles of a node.

#include <string>
#include <string_view>

#include "scenarios/profile/tree_report.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/trace/capture.hpp>

namespace lrb::profile {

/// Returns "AABB", "sphere", "OBB", "RSS" or "k-DOP".
std::string_view volume_name(capture::VolumeKind kind);

/// Returns the tree as an icicle by depth: a node is as wide as its share of the triangles, and coloured by
/// its share of EPO. SVG, at most 40 depths; nodes narrower than a pixel are left out.
std::string icicle_svg(const capture::Tree& tree, const TreeIndex& index, const TreeFigures& figures);

/// Writes the page. `engine`: name of the engine; `command`: that made the page; `trees`: all trees of
/// the capture with links to their pages; no rows for a single tree.
void write_tree_page(const report::Folder& folder, const capture::Tree& tree, const capture::Mesh& mesh,
                     const TreeReport& report, const std::string& engine, const std::string& command,
                     const report::Table& trees, const render::ViewDirection& view = {});

}  // namespace lrb::profile
