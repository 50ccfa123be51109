#pragma once
/// Two pictures that should be the same: side by side, under a swipe, and as their difference.

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace lrb::report {

struct PageComparison {
  std::string id;     ///< letters, digits, _ and -: the page's address ends with it
  std::string title;  ///< and the text under it
  std::string text;
  bool passed = false;
  std::array<std::string, 3> data_uris;  ///< expected, actual, difference; an empty one is left out
  std::array<std::string, 2> captions;   ///< of expected and actual; may be empty
  std::string command;                   ///< the command that approves it; may be empty
};

std::string comparisons_html(const std::vector<PageComparison>& comparisons);

// A table of small pictures: rows x columns, a count and a profile in each cell, and a sheet with the
// details of those cells that have any.

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

// Makes every HTML page and chart of the project: one file that opens from disk, with style, script,
// charting library and pictures inside, and nothing fetched from anywhere.

/// A number that is worth reading first.
struct PageNumber {
  std::string label, value;
  std::string note;  ///< small print under it; may be empty
};

/// A picture of a sequence.
struct PageFrame {
  std::string data_uri;  ///< see assets.hpp
  std::string caption;
  std::string file;   ///< link to the full picture, relative to the page; may be empty
  double event = -1;  ///< where it stands on charts over events; negative: nowhere
  double step = -1;   ///< where it stands on charts over time steps; negative: nowhere
};

struct PageSeries {
  std::string label;
  std::vector<double> x, y;  ///< of one length, x ascending
  // For scatter charts only:
  std::string colour = {}, shape = {};    ///< #rrggbb and Chart.js's name of a shape; empty: the page chooses
  bool line = false;                      ///< points are joined by steps and not drawn
  std::vector<std::string> notes = {};    ///< (|x|) what is said about each point, in lines; or empty
  std::vector<std::string> targets = {};  ///< (|x|) where a click on each point leads, relative to the page;
                                          ///< or empty
};

enum class PageCursor { none, event, step };

/// A chart of lines, or of points if `scatter`. The frame that is shown is marked on it, and a click leads to
/// a frame.
struct PageChart {
  std::string title, x_label, y_label;
  std::string note;  ///< one sentence on how to read the chart; may be empty
  std::vector<PageSeries> series;
  PageCursor cursor = PageCursor::none;  ///< what x counts
  bool log_x = false, log_y = false;
  bool stepped = false;  ///< values hold until the next point
  bool scatter = false;
  double least_x = 0, most_x = 0;  ///< ends of the x axis; equal: as the data have it
};

/// What the first cells of a table's rows number: a click on a row leads to it in the view of the run.
enum class PageRows : std::uint8_t { plain, regions_of_a, regions_of_b, steps };

struct PageTable {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< numbers in them are aligned right
  std::string note;
  PageRows rows_are = PageRows::plain;
};

/// A picture with its caption.
struct PageFigure {
  std::string title, caption;
  std::string data_uri;  ///< see assets.hpp
  std::string file;      ///< link to the full picture, relative to the page; may be empty
  std::string svg =
      {};  ///< in place of data_uri: the picture's own markup, so that its parts can say what they are
};

/// The view in three dimensions of another page, beside this one.
struct PageView {
  std::string title;
  std::string target;  ///< of the page that has it, relative to this one
};

/// A heading and a paragraph.
struct PageText {
  std::string title, text;
};

struct PageLink {
  std::string text, target;  ///< target: relative to the page
  std::string note;
};

/// What a page shows, from top to bottom; empty parts are left out.
struct Page {
  std::string title;
  std::string purpose;          ///< one or two sentences under the title
  std::string verdict;          ///< a short word beside the title, such as the relation of the bodies
  bool is_bad = false;          ///< the verdict is shown as a failure
  std::vector<PageText> texts;  ///< what a reader should know first, side by side
  std::vector<PageNumber> numbers;
  PageGrid grid;
  std::vector<PageComparison> comparisons;
  std::vector<PageView> views;  ///< side by side, with one camera and one time step
  std::string scene;            ///< a run as JSON, for the view in three dimensions (scene.js); empty: none
  std::vector<PageFrame> frames;
  std::string frames_note;
  std::vector<PageChart> charts;
  std::vector<PageTable> tables;
  std::vector<PageFigure> figures;
  std::string command;  ///< that made it, ready to copy
  std::vector<PageLink> links;
  std::string footer;
};

/// Returns what stands at a page's foot: the version that made it, if given, and that it is complete.
std::string footer(const std::string& version = {});

/// Returns the page as HTML.
std::string page_html(const Page& page);

}  // namespace lrb::report
