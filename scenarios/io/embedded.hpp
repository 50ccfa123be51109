#pragma once
/// Text files that are compiled into the program (cmake/embed.cmake): the page's template, the charting
/// library, the schemas and the shipped scenarios. One binary then does everything wherever it is copied to.

#include <span>
#include <string_view>

namespace lrb::io {

struct EmbeddedFile {
  std::string_view name;  ///< without its folder
  std::string_view text;
};

std::span<const EmbeddedFile> embedded_files();
/// Returns the text of a file. Throws EnvironmentError if the program was built without it.
std::string_view embedded_file(std::string_view name);

}  // namespace lrb::io
