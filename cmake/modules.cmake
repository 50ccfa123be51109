# lrb_module(MODULE FOLDER SEEN...): a module, the library lrb_MODULE (alias lrb::MODULE) of all source files of a folder. SEEN: the libraries
# that it links, other modules first. tests/layers/modules.txt lists the allowed dependencies.
function(lrb_module module folder)
  lrb_modules(${module} ${folder} ${ARGN})
endfunction()

# lrb_modules(LIBRARY "FOLDER..." SEEN...): the same for several modules that are compiled together, which saves a quarter of the time: each has
# the alias lrb::FOLDER.
function(lrb_modules library folders)
  add_library(lrb_${library} STATIC)
  target_link_libraries(lrb_${library} PUBLIC ${ARGN} lrb_options)
  foreach(folder IN LISTS folders)
    file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
    target_sources(lrb_${library} PRIVATE ${sources})
    get_filename_component(module ${folder} NAME)
    add_library(lrb::${module} ALIAS lrb_${library})
  endforeach()
endfunction()

# lrb_cold(TARGET...): optimises targets without hot code less, because templates of JSON and of the command line take minutes.
# Not below -O1, because the linker may use their copies of Eigen's functions for the engine.
function(lrb_cold)
  foreach(target IN LISTS ARGN)
    target_compile_options(${target} PRIVATE -O1)
  endforeach()
endfunction()
