#include "scenarios/report/assets.hpp"

#include <algorithm>
#include <bit>
#include <set>
#include <sstream>

#include "scenarios/io/files.hpp"
#include <lrbscope/ids.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::report {
namespace {

void put(std::vector<std::uint8_t>& bytes, std::uint32_t number, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
}

/// Returns the name that a line declares: "f" for "async function f(x) {".
std::string declared_name(const std::string& line) {
  std::istringstream words(line);
  std::string kind, name;
  words >> kind;
  if (kind == "async") words >> kind;
  words >> name;
  return name.substr(0, name.find_first_of("(;={"));
}

/// Modules in one script; see script_of().
struct Bundle {
  std::string script = "\"use strict\";\n";
  std::set<std::string> modules;

  void add(const std::string& module) {
    if (!modules.insert(module).second) return;
    constexpr std::string_view kImport = "import ", kFrom = " from \"./", kEnd = ".js\";",
                               kExport = "export ";
    std::istringstream text{std::string(io::embedded_file(module + ".js"))};
    std::string code, exports;
    for (std::string line; std::getline(text, line); code += line + '\n') {
      const std::size_t from = line.find(kFrom);
      if (line.starts_with(kImport) && from != std::string::npos && line.ends_with(kEnd)) {
        const std::size_t begin = from + kFrom.size();
        const std::string other = line.substr(begin, line.size() - kEnd.size() - begin);
        add(other);
        line = "const " + line.substr(kImport.size(), from - kImport.size()) + " = " + other + "_js;";
      } else if (line.starts_with(kExport)) {
        line.erase(0, kExport.size());
        exports += declared_name(line) + ", ";
      }
    }
    script += "const " + module + "_js = (() => {\n" + code + "return { " + exports + "};\n})();\n";
  }
};

}  // namespace

std::string script_safe(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text)
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  return out;
}

std::string script_of(std::span<const std::string> modules) {
  Bundle bundle;
  for (const std::string& module : modules) bundle.add(module);
  return bundle.script;
}

std::string fill(std::string_view pattern, std::initializer_list<std::string_view> texts) {
  std::string out;
  for (const std::string_view text : texts) {
    const std::size_t open = std::min(pattern.find("{}"), pattern.find("{!}"));
    const bool raw = pattern[open + 1] == '!';
    out += pattern.substr(0, open);
    out += raw ? std::string(text) : render::escape_markup(text);
    pattern.remove_prefix(open + (raw ? 3 : 2));
  }
  return out.append(pattern);
}

std::string filled(std::string_view shape,
                   std::initializer_list<std::pair<std::string_view, std::string_view>> texts) {
  std::string out;
  for (std::size_t open = shape.find("{{"); open != std::string_view::npos; open = shape.find("{{")) {
    const std::size_t close = shape.find("}}", open);
    const std::string_view key = shape.substr(open + 2, close - open - 2);
    out += shape.substr(0, open);
    for (const auto& [name, text] : texts)
      if (name == key) out += text;
    shape.remove_prefix(close + 2);
  }
  return out.append(shape);
}

std::string packed(std::span<const std::uint32_t> numbers) {
  std::uint32_t largest = 0;
  for (const std::uint32_t n : numbers)
    if (n != kNull) largest = std::max(largest, n);
  const int size = largest < 0xFF ? 1 : largest < 0xFFFF ? 2 : 4;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(numbers.size() * static_cast<std::size_t>(size));
  for (const std::uint32_t n : numbers) put(bytes, n, size);  // the low bytes of kNull are all ones
  return "u" + std::to_string(size) + ":" + base64(bytes.data(), bytes.size());
}

std::string packed(std::span<const float> numbers) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(numbers.size() * 4);
  for (const float n : numbers) put(bytes, std::bit_cast<std::uint32_t>(n), 4);
  return "f4:" + base64(bytes.data(), bytes.size());
}

}  // namespace lrb::report

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb_image_write.h>

namespace lrb::report {
namespace {

constexpr int kJpegQuality = 88;  // thin lines keep their edges; file sizes grow quickly above this

void append(void* context, void* data, int size) {
  auto& out = *static_cast<std::vector<std::uint8_t>*>(context);
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  out.insert(out.end(), bytes, bytes + size);
}

/// Encodes an image on a white background, because JPEG has no transparency.
std::vector<std::uint8_t> as_jpeg(const render::Image& image) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(image.pixels().size() * 3);
  for (const render::Rgba& p : image.pixels()) {
    const render::Rgba c = render::over(p, render::kWhite);
    rgb.insert(rgb.end(), {c.r, c.g, c.b});
  }
  std::vector<std::uint8_t> out;
  stbi_write_jpg_to_func(append, &out, image.width(), image.height(), 3, rgb.data(), kJpegQuality);
  return out;
}

InlinedImages as_jpegs(const std::vector<PngBytes>& pngs, int halvings, std::size_t& size) {
  InlinedImages out;
  size = 0;
  for (const PngBytes& png : pngs) {
    render::Image image = render::decode_png(png).image;
    for (int i = 0; i < halvings; ++i) image = halved(image);
    const std::vector<std::uint8_t> jpeg = as_jpeg(image);
    out.uris.push_back(data_uri("image/jpeg", jpeg.data(), jpeg.size()));
    size += out.uris.back().size();
  }
  out.note = "Here as JPEG";
  if (halvings > 0) out.note += ", " + std::to_string(1 << halvings) + " times smaller each way";
  out.note += ", to keep the page light; click the picture for the full one.";
  return out;
}

}  // namespace

std::string data_uri(const std::string& type, const std::uint8_t* bytes, std::size_t size) {
  return "data:" + type + ";base64," + base64(bytes, size);
}

render::Image halved(const render::Image& image) {
  render::Image half(std::max(1, image.width() / 2), std::max(1, image.height() / 2));
  for (int y = 0; y < half.height(); ++y) {
    for (int x = 0; x < half.width(); ++x) {
      const auto mean = [&](auto channel) {
        int sum = 2;
        for (const int dy : {0, 1})
          for (const int dx : {0, 1})
            sum += channel(
                image.at(std::min(2 * x + dx, image.width() - 1), std::min(2 * y + dy, image.height() - 1)));
        return static_cast<std::uint8_t>(sum / 4);
      };
      half.at(x, y) = {
          mean([](const render::Rgba& c) { return c.r; }), mean([](const render::Rgba& c) { return c.g; }),
          mean([](const render::Rgba& c) { return c.b; }), mean([](const render::Rgba& c) { return c.a; })};
    }
  }
  return half;
}

InlinedImages inline_pngs(const std::vector<PngBytes>& pngs, std::size_t budget) {
  std::size_t size = 0;
  for (const PngBytes& png : pngs) size += png.size() / 3 * 4;
  if (size <= budget) {
    InlinedImages out;
    for (const PngBytes& png : pngs) out.uris.push_back(data_uri("image/png", png.data(), png.size()));
    return out;
  }
  constexpr int kMaxHalvings = 4;
  for (int halvings = 0;; ++halvings) {
    InlinedImages out = as_jpegs(pngs, halvings, size);
    if (size <= budget || halvings == kMaxHalvings) return out;
  }
}

}  // namespace lrb::report
