# The engine as WebAssembly for pages (wasm/), compiled by Emscripten if LRB_WASM is ON. Sets LRB_WASM_ENGINE to the script that
# contains it, or to nothing. Include it in the folder that embeds the script.
option(LRB_WASM "Compile the engine to WebAssembly for pages in which a body can be dragged (needs emscripten)" OFF)
set(LRB_WASM_ENGINE "")
if(LRB_WASM)
  find_program(LRB_EMCMAKE emcmake DOC "emcmake of Debian's emscripten")
  if(NOT LRB_EMCMAKE)
    message(FATAL_ERROR " lrbscope: the engine for pages needs Debian's emscripten: install it, or configure with -DLRB_WASM=OFF")
  endif()
  get_target_property(lrb_eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
  get_target_property(lrb_boost Boost::headers INTERFACE_INCLUDE_DIRECTORIES)
  set(lrb_wasm_build ${PROJECT_BINARY_DIR}/wasm)
  set(LRB_WASM_ENGINE ${lrb_wasm_build}/lrbscope_engine.js)
  file(GLOB_RECURSE lrb_wasm_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/wasm/* ${PROJECT_SOURCE_DIR}/engine/*.cpp
       ${PROJECT_SOURCE_DIR}/engine/*.hpp ${PROJECT_SOURCE_DIR}/engine/*.inl)
  # The nested build knows what has changed. NODE_PATH: Debian's emcc finds its JavaScript parser there.
  add_custom_command(
    OUTPUT ${LRB_WASM_ENGINE}
    COMMAND ${CMAKE_COMMAND} -E env "NODE_PATH=/usr/share/nodejs:/usr/lib/nodejs" ${LRB_EMCMAKE} ${CMAKE_COMMAND} -G ${CMAKE_GENERATOR}
            -S ${PROJECT_SOURCE_DIR}/wasm -B ${lrb_wasm_build} -DLRB_EIGEN_INCLUDE=${lrb_eigen} -DLRB_BOOST_INCLUDE=${lrb_boost}
    COMMAND ${CMAKE_COMMAND} -E env "NODE_PATH=/usr/share/nodejs:/usr/lib/nodejs" ${CMAKE_COMMAND} --build ${lrb_wasm_build}
    COMMAND ${CMAKE_COMMAND} -E touch ${LRB_WASM_ENGINE}
    DEPENDS ${lrb_wasm_sources} ${PROJECT_SOURCE_DIR}/cmake/kernels.cmake
    COMMENT "Compiling the engine to WebAssembly"
    VERBATIM)
endif()
