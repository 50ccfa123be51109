# Builds and runs an external project. HOW:
#   package  installs BUILD, and finds it by find_package() and pkg-config
#   shared   the same for shared libraries, built and installed first
#   fetched  fetches the source tree by FetchContent
# SOURCE: this folder. BUILD: a build folder, in which the test works. VERSION, GENERATOR, COMPILER, FLAGS, LAUNCHER.
get_filename_component(tree "${SOURCE}/../.." ABSOLUTE)
set(place "${BUILD}/package test ${HOW}")
set(prefix "${place}/installed")
file(REMOVE_RECURSE "${place}")

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${ARGN}\n${out}")
  endif()
  set(said "${out}" PARENT_SCOPE)
endfunction()

set(toolchain -G "${GENERATOR}" "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_CXX_FLAGS=${FLAGS}")
# Not optimised, because the test only covers finding and linking.
set(ours "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0)
if(HOW STREQUAL "fetched")
  run(${CMAKE_COMMAND} -S "${SOURCE}" -B "${place}/user" ${toolchain} ${ours} -DLRB_FROM=fetched "-DLRB_TREE=${tree}")
  run(${CMAKE_COMMAND} --build "${place}/user" --target user)
  run("${place}/user/user")
  file(REMOVE_RECURSE "${place}")
  return()
endif()

if(HOW STREQUAL "shared")
  run(${CMAKE_COMMAND} -S "${tree}" -B "${place}/build" ${toolchain} ${ours} -DBUILD_SHARED_LIBS=ON -DLRB_BUILD_TESTS=OFF
      -DLRB_BUILD_PROGRAM=OFF)
  run(${CMAKE_COMMAND} --build "${place}/build")
  run(${CMAKE_COMMAND} --install "${place}/build" --prefix "${prefix}")
  # The soname contains the version that programs were compiled for.
  file(GLOB_RECURSE library "${prefix}/liblrb_engine.so.${VERSION}")
  run(objdump -p "${library}")
  string(REGEX MATCH "^[0-9]+\\.[0-9]+" minor "${VERSION}")
  if(NOT said MATCHES "SONAME +liblrb_engine\\.so\\.${minor}\n")
    message(FATAL_ERROR "liblrb_engine.so: expected the soname to end in .${minor}\n${said}")
  endif()
else()
  run(${CMAKE_COMMAND} --install "${BUILD}" --prefix "${prefix}")
  run("${prefix}/bin/lrbscope" --version)
  run(cc -std=c99 -fsyntax-only -x c "${prefix}/include/lrbscope_capture.h")
  # The header for other engines is found without the libraries that the engine needs.
  file(WRITE "${place}/capture/CMakeLists.txt" "cmake_minimum_required(VERSION 3.22)\nproject(c LANGUAGES C)\n\
find_package(lrbscope REQUIRED COMPONENTS capture)\nadd_library(c c.c)\ntarget_link_libraries(c lrb::capture)\n")
  file(WRITE "${place}/capture/c.c" "#include <lrbscope_capture.h>\n")
  run(${CMAKE_COMMAND} -S "${place}/capture" -B "${place}/capture" "-DCMAKE_PREFIX_PATH=${prefix}" -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON)
  run(${CMAKE_COMMAND} --build "${place}/capture")
  set(more -DLRB_WITH_PROGRAM=ON)
endif()

run(${CMAKE_COMMAND} -S "${SOURCE}" -B "${place}/user" ${toolchain} "-DCMAKE_PREFIX_PATH=${prefix}" -DLRB_FROM=package
    "-DLRB_TREE=${tree}" "-DLRB_VERSION=${VERSION}" ${more})
run(${CMAKE_COMMAND} --build "${place}/user")
run("${place}/user/user")
# The examples, as a separate project: the one that needs all libraries. All are compiled with lrbscope itself.
run(${CMAKE_COMMAND} -S "${tree}/examples" -B "${place}/examples" ${toolchain} "-DCMAKE_PREFIX_PATH=${prefix}")
run(${CMAKE_COMMAND} --build "${place}/examples" --target record_and_draw)
set(arguments "${tree}/tests/data/gear.obj" "${tree}/tests/data/l_block.obj" 0 0 0)
run("${place}/examples/record_and_draw" ${arguments} "${place}/drawn")

# By hand and pkg-config, as in a Makefile. lrbscope-trace and -render require lrbscope.
file(GLOB_RECURSE pc "${prefix}/lrbscope.pc")
get_filename_component(pc "${pc}" DIRECTORY)
get_filename_component(lib "${pc}" DIRECTORY)
set(command "eval \"'${COMPILER}' ${FLAGS} -std=c++20 '${tree}/examples/record_and_draw.cpp' -o '${place}/by_hand' \
$(pkg-config --cflags --libs lrbscope-trace lrbscope-render)\"")
run(${CMAKE_COMMAND} -E env "PKG_CONFIG_PATH=${pc}" sh -c "${command}")
run(${CMAKE_COMMAND} -E env "LD_LIBRARY_PATH=${lib}" "${place}/by_hand" ${arguments} "${place}/drawn")
file(REMOVE_RECURSE "${place}")
