#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <dlfcn.h>

#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb_truetype.h>
#pragma GCC diagnostic pop

namespace lrb::render {
namespace {

/// DejaVu's folders in distributions, in case the file found by the build has moved.
constexpr std::array kFontFolders = {"/usr/share/fonts/truetype/dejavu/", "/usr/share/fonts/dejavu/",
                                     "/usr/share/fonts/TTF/", "/usr/share/fonts/dejavu-sans-fonts/",
                                     "/usr/local/share/fonts/"};

bool readable(const std::string& path) {
  return !path.empty() && std::ifstream(path).good();
}

/// Returns the path of a font that was installed with this program, or with this module of Python, in
/// share/lrbscope of their prefix; empty if there is none. The module is five folders below the prefix.
std::string installed_font(const std::string& name) {
  std::error_code error;
  Dl_info self{};
  std::filesystem::path binary;
  // Of a program, dladdr() may know only the name by which it was started.
  if (dladdr(reinterpret_cast<const void*>(&readable), &self) != 0 && self.dli_fname != nullptr)
    binary = std::filesystem::canonical(self.dli_fname, error);
  if (error || !binary.has_parent_path()) binary = std::filesystem::read_symlink("/proc/self/exe", error);
  std::filesystem::path folder = binary.parent_path();
  for (int up = 0; up < 5 && folder.has_relative_path(); ++up) {
    folder = folder.parent_path();
    const std::string path = (folder / "share" / "lrbscope" / name).string();
    if (readable(path)) return path;
  }
  return "";
}

/// A grid of coverage, 0 to 255.
struct Mask {
  int width = 0, height = 0;
  std::vector<std::uint8_t> at;
  Mask(int w, int h) : width(w), height(h), at(static_cast<std::size_t>(w) * h) {}
  std::uint8_t& operator()(int x, int y) { return at[static_cast<std::size_t>(y) * width + x]; }
  std::uint8_t operator()(int x, int y) const { return at[static_cast<std::size_t>(y) * width + x]; }
};

/// Dilates the mask by a disc with a soft border.
Mask dilate(const Mask& mask, float radius) {
  struct Tap {
    int x, y, weight;
  };
  // The disc's coverage, with a border one pixel wide.
  std::vector<Tap> taps;
  const int reach = static_cast<int>(std::ceil(radius));
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const float weight =
          std::clamp(radius + 0.5F - std::sqrt(static_cast<float>(x * x + y * y)), 0.0F, 1.0F);
      if (weight > 0) taps.push_back({x, y, static_cast<int>(weight * 255 + 0.5F)});
    }
  }
  Mask out(mask.width, mask.height);
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      // Maximum, not sum: overlapping copies must not exceed full coverage.
      if (mask(x, y) == 0) continue;
      for (const Tap& t : taps) {
        const int i = x + t.x, j = y + t.y;
        if (i < 0 || j < 0 || i >= out.width || j >= out.height) continue;
        out(i, j) = std::max(out(i, j), static_cast<std::uint8_t>(div255(mask(x, y) * t.weight)));
      }
    }
  }
  return out;
}

}  // namespace

std::string find_font(bool bold) {
  // The environment comes first, then an installed font, then that of the build, then the usual folders.
  for (const char* variable : {bold ? "LRB_FONT_BOLD" : "LRB_FONT", "LRB_FONT"}) {
    const char* path = std::getenv(variable);
    if (path == nullptr || *path == '\0') continue;
    if (!readable(path))
      throw EnvironmentError(std::string(variable) + " names '" + path + "', which cannot be read");
    return path;
  }
  const std::string name = bold ? "DejaVuSans-Bold.ttf" : "DejaVuSans.ttf";
  static const std::string installed[] = {installed_font("DejaVuSans.ttf"),
                                          installed_font("DejaVuSans-Bold.ttf")};
  if (!installed[bold].empty()) return installed[bold];
  const std::string built_with = bold ? LRB_FONT_BOLD_FILE : LRB_FONT_FILE;
  if (readable(built_with)) return built_with;
  for (const char* folder : kFontFolders) {
    if (readable(folder + name)) return folder + name;
  }
  throw EnvironmentError("no font found: " + name +
                         " is missing; install fonts-dejavu-core, or set LRB_FONT to a .ttf file");
}

struct Font::Faces {
  struct Face {
    std::vector<unsigned char> bytes;
    stbtt_fontinfo info{};
    int ascent = 0, descent = 0, gap = 0;

    explicit Face(const std::string& path) {
      std::ifstream file(path, std::ios::binary);
      bytes.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
      const int offset = bytes.size() < 12 ? -1 : stbtt_GetFontOffsetForIndex(bytes.data(), 0);
      if (offset < 0 || stbtt_InitFont(&info, bytes.data(), offset) == 0) {
        throw EnvironmentError(path + ": not a TrueType font; set LRB_FONT to another one");
      }
      stbtt_GetFontVMetrics(&info, &ascent, &descent, &gap);
    }

    /// Calls visit(glyph, x of its origin in pixels) along a line; returns the line's advance in pixels.
    template <class Visit>
    float walk(std::string_view text, float scale, Visit&& visit) const {
      float x = 0;
      int previous = 0;
      while (!text.empty()) {
        // Kerning depends on the pair of glyphs.
        const int glyph = stbtt_FindGlyphIndex(&info, static_cast<int>(next_code_point(text)));
        if (previous != 0) x += scale * static_cast<float>(stbtt_GetGlyphKernAdvance(&info, previous, glyph));
        visit(glyph, x);
        int advance = 0, bearing = 0;
        stbtt_GetGlyphHMetrics(&info, glyph, &advance, &bearing);
        x += scale * static_cast<float>(advance);
        previous = glyph;
      }
      return x;
    }
  };
  Face regular{find_font(false)}, bold{find_font(true)};
};

Font::Font() : faces_(std::make_unique<Faces>()) {}
Font::~Font() = default;
Font::Font(Font&&) noexcept = default;

TextSize Font::measure(std::string_view text, const TextStyle& style) const {
  const auto& face = style.bold ? faces_->bold : faces_->regular;
  // Round outward, so that nothing is clipped.
  const float scale = stbtt_ScaleForPixelHeight(&face.info, style.height);
  TextSize size;
  size.width = static_cast<int>(std::ceil(face.walk(text, scale, [](int, float) {})));
  size.ascent = static_cast<int>(std::ceil(scale * static_cast<float>(face.ascent)));
  size.height = size.ascent + static_cast<int>(std::ceil(scale * static_cast<float>(-face.descent)));
  return size;
}

void Font::draw(Image& image, std::string_view text, int x, int y, const TextStyle& style) const {
  const auto& face = style.bold ? faces_->bold : faces_->regular;
  const float scale = stbtt_ScaleForPixelHeight(&face.info, style.height);
  const TextSize size = measure(text, style);
  if (size.width == 0) return;
  if (style.align == Align::centre) x -= size.width / 2;
  if (style.align == Align::right) x -= size.width;

  const int pad =
      2 + static_cast<int>(std::ceil(style.halo_width));  // glyphs may extend slightly beyond the advance
  // Step 1: render all glyphs into one coverage mask, at subpixel positions.
  Mask ink(size.width + 2 * pad, size.height + 2 * pad);
  face.walk(text, scale, [&](int glyph, float at) {
    const float whole = std::floor(at), part = at - whole;
    int gx = 0, gy = 0, gw = 0, gh = 0;
    unsigned char* bitmap =
        stbtt_GetGlyphBitmapSubpixel(&face.info, scale, scale, part, 0, glyph, &gw, &gh, &gx, &gy);
    for (int j = 0; j < gh; ++j) {
      for (int i = 0; i < gw; ++i) {
        const int px = pad + static_cast<int>(whole) + gx + i, py = pad + size.ascent + gy + j;
        if (px < 0 || py < 0 || px >= ink.width || py >= ink.height) continue;
        std::uint8_t& to = ink(px, py);
        to = static_cast<std::uint8_t>(std::min(255, to + bitmap[j * gw + i]));
      }
    }
    stbtt_FreeBitmap(bitmap, nullptr);
  });

  // Step 2: paint the mask, over its dilation if there is a halo.
  const auto paint = [&](const Mask& mask, Rgba colour) {
    for (int j = 0; j < mask.height; ++j) {
      for (int i = 0; i < mask.width; ++i) {
        if (mask(i, j) != 0) image.blend(x - pad + i, y - pad + j, colour, mask(i, j));
      }
    }
  };
  if (style.halo.a > 0 && style.halo_width > 0) paint(dilate(ink, style.halo_width), style.halo);
  paint(ink, style.colour);
}

std::vector<std::string> Font::wrap(std::string_view text, int width, const TextStyle& style) const {
  const auto fits = [&](const std::string& s) { return measure(s, style).width <= width; };
  std::vector<std::string> lines;
  std::string line;
  // Greedy line breaking. A word wider than the line is broken between code points.
  const auto add_word = [&](std::string_view word) {
    const std::string joined = line.empty() ? std::string(word) : line + " " + std::string(word);
    if (fits(joined)) {
      line = joined;
      return;
    }
    if (!line.empty()) lines.push_back(std::move(line));
    line.clear();
    while (!word.empty()) {  // by code points, as many as fit, at least one
      std::string_view rest = word;
      next_code_point(rest);
      const std::string next = line + std::string(word.substr(0, word.size() - rest.size()));
      if (!line.empty() && !fits(next)) {
        lines.push_back(std::move(line));
        line.clear();
        continue;
      }
      line = next;
      word = rest;
    }
  };
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    if (end > 0) add_word(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (!line.empty()) lines.push_back(std::move(line));
  return lines;
}

const Font& default_font() {
  static const Font font;
  return font;
}

char32_t next_code_point(std::string_view& text) {
  constexpr char32_t kBad = 0xFFFD;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = io::utf8_length(text);
  char32_t code = length == 0 ? kBad : length == 1 ? first : first & (0x7F >> length);
  // Continuation bytes carry six bits each.
  for (std::size_t i = 1; i < length; ++i) code = code << 6 | (byte(i) & 0x3F);
  text.remove_prefix(std::max<std::size_t>(length, 1));  // invalid bytes are replaced one at a time
  return code;
}

}  // namespace lrb::render
