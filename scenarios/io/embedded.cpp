#include "scenarios/io/embedded.hpp"

#include <string>

#include "engine/core/error.hpp"

namespace lrb::io {

std::string_view embedded_file(std::string_view name) {
  for (const EmbeddedFile& file : embedded_files())
    if (file.name == name) return file.text;
  throw EnvironmentError("the program was built without its file " + std::string(name) + ": build it again");
}

}  // namespace lrb::io
