# lrb_registry(TARGET NAMESPACE HEADER ITEM KIND SOURCE...): registers the items of all SOURCE files, so that no list of files
# is needed. Every SOURCE, named NAME.cpp or NAME_KIND.cpp, must define `std::vector<ITEM> NAME_KIND()` in NAMESPACE.
# Generates `std::vector<ITEM> registered_KIND()` (declared in HEADER), which returns all items by rank_of(item), then by
# file, and compiles it into TARGET. It calls each function by name, so that the linker cannot drop one or change the order.
function(lrb_registry target namespace header item kind)
  set(names "")
  foreach(source IN LISTS ARGN)
    get_filename_component(name "${source}" NAME_WE)
    string(REGEX REPLACE "_${kind}$" "" name "${name}")
    list(APPEND names ${name})
  endforeach()
  list(SORT names)
  set(declarations "")
  set(calls "")
  foreach(name IN LISTS names)
    string(APPEND declarations "std::vector<${item}> ${name}_${kind}();\n")
    string(APPEND calls "  add(${name}_${kind}());\n")
  endforeach()
  set(out "${CMAKE_CURRENT_BINARY_DIR}/registered/${target}_${kind}.cpp")
  file(CONFIGURE OUTPUT "${out}" @ONLY CONTENT
"// Written by cmake/registry.cmake.
#include <algorithm>
#include <utility>
#include <vector>

#include \"@header@\"

namespace @namespace@ {

@declarations@
std::vector<@item@> registered_@kind@() {
  std::vector<@item@> all;
  const auto add = [&](std::vector<@item@> some) {
    for (@item@& one : some) all.push_back(std::move(one));
  };
@calls@  std::stable_sort(all.begin(), all.end(), [](const @item@& x, const @item@& y) { return rank_of(x) < rank_of(y); });
  return all;
}

}  // namespace @namespace@
")
  target_sources(${target} PRIVATE "${out}")
endfunction()
