# The target api: makes the reference of the public headers with Doxygen, and fails on any warning.
find_program(LRB_DOXYGEN doxygen DOC "Doxygen, for the target api")
set(LRB_API_INPUT "\"${PROJECT_SOURCE_DIR}/docs/library.md\"")
foreach(header IN LISTS LRB_PUBLIC_HEADERS)
  string(APPEND LRB_API_INPUT " \\\n    \"${PROJECT_SOURCE_DIR}/${header}\"")
endforeach()
configure_file(${PROJECT_SOURCE_DIR}/docs/Doxyfile.in ${PROJECT_BINARY_DIR}/Doxyfile @ONLY)
if(LRB_DOXYGEN)
  add_custom_target(api
    COMMAND ${LRB_DOXYGEN} ${PROJECT_BINARY_DIR}/Doxyfile
    COMMAND ${CMAKE_COMMAND} -E echo "${PROJECT_BINARY_DIR}/api/html/index.html"
    VERBATIM)
else()
  add_custom_target(api COMMAND ${CMAKE_COMMAND} -E echo "api: doxygen is not installed: install it and configure again"
                        COMMAND ${CMAKE_COMMAND} -E false VERBATIM)
endif()
