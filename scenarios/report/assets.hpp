#pragma once
/// Parts of pages: scripts, pictures, texts filled into HTML, and number arrays as text for scene_run.js: a
/// prefix for the type and size of an element ("u1:", "u2:", "u4:" or "f4:"), then the elements in base64,
/// little-endian.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/canvas.hpp"

namespace lrb::report {

using PngBytes = std::vector<std::uint8_t>;

/// Maximum total size of a page's pictures, in bytes. Browsers hold several copies of a data URI while they
/// parse a page; pages above some 15 MB open with a noticeable delay.
inline constexpr std::size_t kInlineBudget = 15'000'000;

/// Pictures as data URIs for embedding in a page. If all fit into the budget they are unchanged; otherwise
/// they become JPEGs, at half or a quarter of the size if necessary. The PNG files beside the page keep every
/// pixel.
struct InlinedImages {
  std::vector<std::string> uris;
  std::string note;  ///< the conversion applied, for the page; empty if none
};
InlinedImages inline_pngs(const std::vector<PngBytes>& pngs, std::size_t budget = kInlineBudget);

/// Returns a picture of half the size each way. Each pixel is the mean of four.
render::Image halved(const render::Image& image);

/// Returns "data:TYPE;base64,...".
std::string data_uri(const std::string& type, const std::uint8_t* bytes, std::size_t size);

using render::base64;

/// Returns HTML. Each "{}" of a pattern is replaced by the next text, escaped; each "{!}" by the next text,
/// unescaped.
std::string fill(std::string_view pattern, std::initializer_list<std::string_view> texts);

/// Returns a template with each "{{key}}" replaced by its text, in one pass: keys inside the texts are not
/// replaced.
std::string filled(std::string_view shape,
                   std::initializer_list<std::pair<std::string_view, std::string_view>> texts);

/// Returns JSON that is safe inside a script element: it cannot close the element.
std::string script_safe(std::string_view text);

/// Returns the script of a page that needs the given ES modules: the embedded files MODULE.js. Browsers load
/// no modules for a page from disk, so the script contains each of them, and all that they import, once,
/// after what it imports: `const MODULE_js = (() => { ... return { exports }; })();`.
std::string script_of(std::span<const std::string> modules);

/// Packs the numbers at the smallest element size that fits the largest. The maximum value of that size
/// encodes kNull.
std::string packed(std::span<const std::uint32_t> numbers);
std::string packed(std::span<const float> numbers);

}  // namespace lrb::report
