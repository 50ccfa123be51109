# lrb_room(ROOM FOLDER SEEN...): every source file of a folder as the library lrb_ROOM, alias lrb::ROOM; the rest: what it
# links, other rooms first. Which rooms a room may see stands in tests/layers/rooms.txt.
function(lrb_room room folder)
  file(GLOB sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  add_library(lrb_${room} STATIC ${sources})
  add_library(lrb::${room} ALIAS lrb_${room})
  target_link_libraries(lrb_${room} PUBLIC ${ARGN} lrb_options)
endfunction()

# lrb_cold(TARGET...): targets in which nothing takes long; templates of JSON and of the command line take minutes to
# optimise. Not less than this: the linker may take what they compile of Eigen for the engine, too.
function(lrb_cold)
  foreach(target IN LISTS ARGN)
    target_compile_options(${target} PRIVATE -O1)
  endforeach()
endfunction()
