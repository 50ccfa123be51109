# lrb_module(MODULE FOLDER SEEN...): a module, the library lrb_MODULE (alias lrb::MODULE) of all source files of a folder. SEEN: the libraries
# that it links, other modules first. tests/layers/modules.txt lists the allowed dependencies.
function(lrb_module module folder)
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  add_library(lrb_${module} STATIC ${sources})
  add_library(lrb::${module} ALIAS lrb_${module})
  target_link_libraries(lrb_${module} PUBLIC ${ARGN} lrb_options)
endfunction()

# lrb_cold(TARGET...): optimises targets without hot code less, because templates of JSON and of the command line take minutes.
# Not below -O1, because the linker may use their copies of Eigen's functions for the engine.
function(lrb_cold)
  foreach(target IN LISTS ARGN)
    target_compile_options(${target} PRIVATE -O1)
  endforeach()
endfunction()
