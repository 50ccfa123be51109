# lrb_embed(TARGET FILE...): compiles text files into TARGET; lrb::io::embedded_file(NAME) returns their text, where NAME is
# the file's name without its folder (scenarios/io/files.hpp). Files may lie outside the source tree.
# Run as a script (-P), this file writes the texts that EMBED_LIST lists as C++ source.
if(CMAKE_SCRIPT_MODE_FILE)
  file(STRINGS "${EMBED_LIST}" paths)
  file(WRITE "${EMBED_OUT}" "#include \"scenarios/io/files.hpp\"

std::span<const lrb::io::EmbeddedFile> lrb::io::embedded_files() {
  static const EmbeddedFile files[] = {\n")
  foreach(path IN LISTS paths)
    file(READ "${path}" text)
    string(FIND "${text}" ")lrb_embed\"" clash)
    if(NOT clash EQUAL -1)
      message(FATAL_ERROR "${path} contains the end mark of a raw string")
    endif()
    get_filename_component(name "${path}" NAME)
    file(APPEND "${EMBED_OUT}" "{\"${name}\", R\"lrb_embed(${text})lrb_embed\"},\n")
  endforeach()
  file(APPEND "${EMBED_OUT}" "};\n  return files;\n}\n")
  return()
endif()

set(LRB_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

function(lrb_embed target)
  set(paths "")
  foreach(file IN LISTS ARGN)
    get_filename_component(path "${file}" ABSOLUTE)
    list(APPEND paths "${path}")
  endforeach()
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/embedded")
  list(JOIN paths "\n" lines)
  file(CONFIGURE OUTPUT "${folder}/list.txt" @ONLY CONTENT "${lines}\n")
  add_custom_command(
    OUTPUT "${folder}/embedded.cpp"
    COMMAND ${CMAKE_COMMAND} "-DEMBED_LIST=${folder}/list.txt" "-DEMBED_OUT=${folder}/embedded.cpp" -P "${LRB_EMBED_SCRIPT}"
    DEPENDS ${paths} "${folder}/list.txt" "${LRB_EMBED_SCRIPT}"
    VERBATIM)
  # No warnings about long literals.
  set_source_files_properties("${folder}/embedded.cpp" PROPERTIES COMPILE_OPTIONS -Wno-overlength-strings)
  target_sources(${target} PRIVATE "${folder}/embedded.cpp")
endfunction()
