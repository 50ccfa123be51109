#pragma once
/// A table of small pictures: rows x columns, a count and a profile in each cell, and a sheet with the
/// details of those cells that have any.

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace lrb::report {

/// The parts that the bars of a profile are stacked of, from the bottom. Each has a colour and a mark.
enum class PagePart : std::uint8_t { wrong, crashed, timed_out, refused };
inline constexpr std::size_t kPageParts = 4;

struct PageGridHead {
  std::string title;
  std::string text;               ///< small print under it
  std::string low, high;          ///< rows: what the ends of the profiles mean; may be empty
  std::vector<std::string> axis;  ///< rows: what each bar of the profiles means, "1e-6"; or empty
};

struct PageGridCell {
  /// The background: from 0, nothing to report, to 4; kOnlyRefused has one of its own.
  static constexpr int kOnlyRefused = -1;
  int level = 0;
  std::string count, of;                             ///< "12", "of 55"
  std::array<std::string, kPageParts> marks;         ///< numbers shown beside the parts' marks; empty: none
  std::vector<std::array<double, kPageParts>> bars;  ///< shares in [0, 1]; a negative first one: not tried
  std::string label;                                 ///< the whole cell in words
  int detail = -1;                                   ///< index into PageGrid::details
};

struct PageGridDetail {
  std::string id;     ///< letters, digits and dashes: the page's address ends with it
  std::string title;  ///< and the text under it
  std::string text;
  std::string data_uri;  ///< of its picture; may be empty
  std::string file;      ///< link to the full picture; may be empty
  std::vector<std::pair<std::string, std::string>> facts;
  std::string note;
  std::string command;
};

struct PageGrid {
  std::string title, corner;             ///< corner: over the rows' heads
  std::vector<std::string> level_names;  ///< of levels 0 to 4
  std::array<std::string, kPageParts> part_names;
  std::string note;
  std::string missing;  ///< what could have a column and has none, in a sentence; may be empty
  std::vector<PageGridHead> columns, rows;
  std::vector<PageGridCell> cells;  ///< (|rows| x |columns|), row by row
  std::size_t total_rows = 0;       ///< this many of the last rows are sums over those above
  std::vector<PageGridDetail> details;

  bool empty() const { return cells.empty(); }
};

std::string grid_html(const PageGrid& grid);

}  // namespace lrb::report
