# lrb_room(ROOM FOLDER SEEN...): a module, the library lrb_ROOM (alias lrb::ROOM) of all source files of a folder. SEEN: the libraries
# that it links, other modules first. tests/layers/rooms.txt lists the allowed dependencies.
function(lrb_room room folder)
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  add_library(lrb_${room} STATIC ${sources})
  add_library(lrb::${room} ALIAS lrb_${room})
  target_link_libraries(lrb_${room} PUBLIC ${ARGN} lrb_options)
endfunction()

# lrb_cold(TARGET...): optimises targets without hot code less, because templates of JSON and of the command line take minutes.
# Not below -O1, because the linker may use their copies of Eigen's functions for the engine.
function(lrb_cold)
  foreach(target IN LISTS ARGN)
    target_compile_options(${target} PRIVATE -O1)
  endforeach()
endfunction()
