# lrb_kernel(TARGET NAME FILE): compiles the kernel FILE, an .inl, once per instruction set. The best one for the processor
# is chosen at run time. Each compilation names its function run_NAME_SET, by a macro such as LRB_TREE_KERNEL_NAME for
# tree_kernel.
function(lrb_kernel target name file)
  set(sets baseline)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND sets avx2 avx512)
  endif()
  string(TOUPPER "${name}" macro)
  set(options_avx2 -mavx2)
  set(options_avx512 -mavx2 -mbmi -mbmi2 -mpopcnt -mavx512f -mavx512vl -mavx512dq -mavx512bw -mprefer-vector-width=256)
  if(MINGW AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # gcc does not align the stack to 32 bytes on Windows (gcc bug 54412), so its aligned moves would fail.
    list(APPEND options_avx2 -Wa,-muse-unaligned-vector-move)
    list(APPEND options_avx512 -Wa,-muse-unaligned-vector-move)
  endif()
  foreach(set IN LISTS sets)
    set(out "${CMAKE_CURRENT_BINARY_DIR}/kernels/${name}_${set}.cpp")
    file(CONFIGURE OUTPUT "${out}" @ONLY CONTENT
"// Written by cmake/kernels.cmake.
#define LRB_@macro@_NAME run_@name@_@set@
#include \"@file@\"
")
    target_sources(${target} PRIVATE "${out}")
    set_source_files_properties("${out}" TARGET_DIRECTORY ${target} PROPERTIES COMPILE_OPTIONS "${options_${set}}" SKIP_UNITY_BUILD_INCLUSION ON)
  endforeach()
endfunction()
