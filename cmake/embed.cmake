# lrb_embed(TARGET FILE...): compiles text files into TARGET; lrb::io::embedded_file(NAME) returns their text, where NAME is
# the file's name without its folder (scenarios/io/files.hpp). Files may lie outside the source tree.
# Run as a script (-P), this file writes one such text as C++ source.
if(CMAKE_SCRIPT_MODE_FILE)
  file(READ "${EMBED_IN}" text)
  string(FIND "${text}" ")lrb_embed\"" clash)
  if(NOT clash EQUAL -1)
    message(FATAL_ERROR "${EMBED_IN} contains the end mark of a raw string")
  endif()
  get_filename_component(name "${EMBED_IN}" NAME)
  file(WRITE "${EMBED_OUT}" "extern const char* const ${EMBED_SYMBOL};\nconst char* const ${EMBED_SYMBOL} = R\"lrb_embed(${text})lrb_embed\";\n")
  return()
endif()

set(LRB_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

function(lrb_embed target)
  set(declarations "")
  set(table "")
  set(generated "")
  foreach(file IN LISTS ARGN)
    get_filename_component(path "${file}" ABSOLUTE)
    get_filename_component(name "${file}" NAME)
    string(MAKE_C_IDENTIFIER "lrb_embedded_${name}" symbol)
    set(out "${CMAKE_CURRENT_BINARY_DIR}/embedded/${symbol}.cpp")
    add_custom_command(
      OUTPUT "${out}"
      COMMAND ${CMAKE_COMMAND} "-DEMBED_IN=${path}" "-DEMBED_OUT=${out}" "-DEMBED_SYMBOL=${symbol}" -P "${LRB_EMBED_SCRIPT}"
      DEPENDS "${path}" "${LRB_EMBED_SCRIPT}"
      VERBATIM)
    list(APPEND generated "${out}")
    string(APPEND declarations "extern const char* const ${symbol};\n")
    string(APPEND table "      {\"${name}\", ${symbol}},\n")
  endforeach()
  # No warnings about long literals.
  set_source_files_properties(${generated} PROPERTIES COMPILE_OPTIONS -Wno-overlength-strings
                              SKIP_PRECOMPILE_HEADERS ON)
  set(registry "${CMAKE_CURRENT_BINARY_DIR}/embedded/registry.cpp")
  file(CONFIGURE OUTPUT "${registry}" @ONLY CONTENT
"#include \"scenarios/io/files.hpp\"

@declarations@
namespace lrb::io {
std::span<const EmbeddedFile> embedded_files() {
  static const EmbeddedFile files[] = {
@table@  };
  return files;
}
}  // namespace lrb::io
")
  target_sources(${target} PRIVATE "${registry}" ${generated})
endfunction()
