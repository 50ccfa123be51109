#pragma once
/// Reports: self-contained HTML files with style, script, charting library and pictures, which open from disk
/// and fetch nothing; and the files beside them.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/io/files.hpp"
#include "scenarios/report/assets.hpp"
#include "scenarios/report/chart.hpp"
#include <lrbscope/render/image.hpp>

namespace lrb::report {

/// A key figure, shown in a tile.
struct Number {
  std::string label, value;
  std::string note = {};
};

struct Table {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows = {};
  std::string note = {};
  /// The items that the rows are about, for as many of the first rows: a click on such a row selects the item
  /// in the view of the run. "step NUMBER", "region SIDE NUMBER" (side 0 or 1), "boxes DEPTH" (of tree
  /// nodes), "pair STEP A B" (simplices of A and B), or empty. Of "#ID" and "FILE.html", the first cell is a
  /// link to that place.
  std::vector<std::string> targets = {};
  std::vector<PngBytes> pictures = {};  ///< small ones, under the links of as many first rows; may be empty
  bool folded = false;                  ///< a page shows only the title until it is clicked
};

/// Returns columns and rows of a table as CSV (RFC 4180), for other programs. Cells with a comma, a quote or
/// a line break are quoted.
std::string csv(const Table& table);
/// Returns the number of characters (code points) of UTF-8 text.
std::size_t characters_of(std::string_view text);
/// Returns rows as lines of columns that are two spaces apart: the first `left` aligned left, the others
/// right. The last cell of a row with more or fewer cells than the first row may exceed its column.
std::string in_columns(const std::vector<std::vector<std::string>>& rows, std::size_t left = 1);
/// Returns columns and rows of a table in this form.
std::string in_columns(const Table& table, std::size_t left = 1);

/// Returns a table as a LaTeX tabular with the rules of the package booktabs. Columns of numbers are aligned
/// right. Successive rows with the same first cell form a group: it is written once, with a rule between
/// groups.
std::string booktabs(const Table& table);

/// A heading and a paragraph.
struct Text {
  std::string title, text;
};

/// A picture of a sequence, which is in the report's folder.
struct Frame {
  std::string file, caption;
  double event = -1;  ///< its x on charts over events; negative: none
  double step = -1;   ///< its x on charts over time steps; negative: none
};

/// Two pictures that should be equal: side by side, under a swipe, and as their difference.
struct Comparison {
  std::string id;  ///< letters, digits, _ and -: fragment of the page's address
  std::string title, text;
  bool passed = false;
  std::array<PngBytes, 3> pngs = {};         ///< expected, actual, difference; an empty one is left out
  std::array<std::string, 2> captions = {};  ///< of expected and actual; may be empty
  std::string command = {};                  ///< the command that approves it; may be empty
};

/// The parts stacked in the bars of a grid's profiles, from the bottom. Each has a colour and a mark.
enum class Part : std::uint8_t { wrong, crashed, timed_out, rejected };
inline constexpr std::size_t kParts = 4;

struct GridHead {
  std::string title;
  std::string text = {};               ///< small print under it
  std::string low = {}, high = {};     ///< rows: meaning of the ends of the profiles; may be empty
  std::vector<std::string> axis = {};  ///< rows: meaning of each bar of the profiles, "1e-6"; or empty
};

struct GridCell {
  /// The background, from 0 (no finding) to 4. kOnlyRejected has its own background.
  static constexpr int kOnlyRejected = -1;
  int level = 0;
  std::string count, of;                         ///< "12", "of 55"
  std::array<std::string, kParts> marks;         ///< numbers shown beside the parts' marks; empty: none
  std::vector<std::array<double, kParts>> bars;  ///< shares in [0, 1]; a negative first one: not tried
  std::string label;                             ///< the text of the whole cell
  int detail = -1;                               ///< index into Grid::details
};

struct GridDetail {
  std::string id;  ///< letters, digits and dashes: fragment of the page's address
  std::string title, text;
  std::string file;  ///< its picture, in the report's folder; may be empty
  std::vector<std::pair<std::string, std::string>> facts;
  std::string note, command;
};

/// A table of small pictures: rows x columns, with a count and a profile in each cell, and a sheet of details
/// for each cell that has some.
struct Grid {
  std::string title, corner;             ///< corner: over the rows' heads
  std::vector<std::string> level_names;  ///< names of levels 0 to 4
  std::array<std::string, kParts> part_names;
  std::string note;
  std::string missing;  ///< columns that are not available, in a sentence; may be empty
  std::vector<GridHead> columns, rows;
  std::vector<GridCell> cells;  ///< (|rows| x |columns|), row by row
  std::size_t total_rows = 0;   ///< number of last rows that are sums of those above
  std::vector<GridDetail> details;
};

/// The 3D view of another page, beside this one.
struct View {
  std::string title;
  std::string target;  ///< that page, relative to this one
};

/// Returns a grid as HTML; `images`: pictures of the details that have a file, in their order.
std::string grid_html(const Grid& grid, const InlinedImages& images);

/// A file of a report, listed on its page. `text`: the link's text, unless it is the target.
struct Link {
  std::string target, note = {}, text = {};
};

/// An output folder for writing: created if missing, locked against other processes, and without links under
/// the names that reports write (see reject_links()). A created folder that stays empty is removed.
class Folder {
 public:
  Folder(std::string path);  // NOLINT(google-explicit-constructor): a path names the folder
  Folder(const char* path) : Folder(std::string(path)) {}  // NOLINT(google-explicit-constructor)
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  operator const std::string&() const { return path_; }  // NOLINT(google-explicit-constructor)

 private:
  std::string path_;
  bool existed_;
  io::FolderLock lock_;
};

/// The contents of a report, in order of addition. Texts and key figures come first, the command and the
/// files last.
class Document {
 public:
  explicit Document(std::string title, std::string purpose = {});

  Document& purpose(std::string_view more);  ///< appends a sentence to the text under the title
  Document& verdict(std::string word, bool good = true);
  Document& version(std::string lrbscope);  ///< in the footer, instead of this program's version
  Document& command(std::string command);   ///< the command that made the report
  Document& link(const Link& link);
  Document& summary(std::string sentence);  ///< the run in a sentence, under the title
  /// Sets the function that explains column titles and labels of key figures, in their tooltips. It returns
  /// an empty text for a name that needs no explanation.
  Document& explain(std::string_view (*meaning_of)(std::string_view name));
  /// Puts the parts that are added from now on into a tab of the page of a run. Tabs of one name are one.
  Document& tab(const std::string& name);

  Document& text(const Text& text);        ///< at the top, side by side
  Document& reading(const Text& text);     ///< folded under "How to read this page", at the end
  Document& number(const Number& number);  ///< below the texts, in a row
  Document& chart(const Chart& chart);
  Document& table(const Table& table);
  /// Writes each table that is added from now on to a file, too: its title, with dashes, and .tex.
  Document& tables_as_tex(bool on);
  Document& grid(const Grid& grid, const std::string& folder);
  Document& comparisons(const std::vector<Comparison>& comparisons);
  Document& views(const std::vector<View>& views);  ///< with one camera and one time step
  Document& scene(const std::string& json);         ///< a run, for the 3D view
  Document& tree_view(const std::string& json);     ///< a body and its tree, for the 3D view
  Document& key_figures();                          ///< those so far, here instead of at the top
  /// Pictures of a sequence, whose files are in `folder`. `budget`: see inline_pngs().
  Document& frames(const std::vector<Frame>& frames, const std::string& folder,
                   std::size_t budget = kInlineBudget);
  /// A picture, .png or .svg, written by write(). The parts of a `live` .svg show their description under the
  /// pointer.
  Document& picture(const std::string& file, std::string bytes, const std::string& title,
                    const std::string& caption, bool live = false);
  Document& picture(const std::string& file, const render::Image& image, const std::string& title,
                    const std::string& caption);
  /// A file beside the page, written by write().
  Document& file(const std::string& name, std::string bytes, const std::string& note);
  /// Charts for print: NAME.svg, and NAME.png or NAME.pdf. Without gnuplot they are left out, and notes()
  /// says so. Returns the .svg.
  std::string print(const std::string& name, const std::string& note, const Gnuplot& chart,
                    bool as_pdf = false);

  /// Adds all elements of a range, such as tables.
  template <class Parts, class P>
  Document& each(const Parts& parts, Document& (Document::*adder)(const P&)) {
    for (const P& part : parts) (this->*adder)(part);
    return *this;
  }

  const std::string& title() const { return title_; }
  const std::vector<std::string>& notes() const { return notes_; }
  /// Returns the names of the files that write() writes, the page first.
  std::vector<std::string> written() const;

  std::string html() const;
  /// Writes index.html and the files.
  void write(const Folder& folder) const;

 private:
  /// Appends to the body. Consecutive charts are side by side.
  Document& add(std::string_view html, bool is_chart = false);
  void close_charts();
  /// Returns the attribute that explains a name, or an empty text.
  std::string tooltip(std::string_view name) const;
  /// Adds a style sheet and a module of scripts.
  void use(const std::string& style, const std::string& module);
  /// Adds a 3D view: its data, NAME.html, and the module NAME.
  Document& view(const std::string& json, const std::string& name);

  std::string title_, purpose_, summary_, verdict_, footer_, command_, tab_;
  std::string_view (*meaning_of_)(std::string_view) = nullptr;
  std::string texts_, reading_, numbers_, body_;
  std::string styles_, libraries_, view_data_, charts_, frames_ = "[]";
  std::vector<std::string> modules_{"page"};
  bool of_run_ = false, framing_ = false, in_charts_ = false, tables_as_tex_ = false;
  std::size_t chart_count_ = 0;
  std::vector<Link> links_;
  std::vector<std::pair<std::string, std::string>> files_;
  std::vector<std::string> notes_;
};

}  // namespace lrb::report
