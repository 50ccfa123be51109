# Completions, printed by the program, and manual pages, which help2man makes of each --help.
if(NOT LRB_BUILD_PROGRAM)
  return()
endif()
set(completion ${PROJECT_BINARY_DIR}/completion)
find_program(LRB_HELP2MAN help2man DOC "help2man, for the manual pages")
find_program(LRB_GZIP gzip DOC "gzip, for the manual pages")
lrb_need("manual pages" help2man LRB_HELP2MAN)
lrb_need("manual pages" gzip LRB_GZIP)
set(manual COMMAND ${CMAKE_COMMAND} -E make_directory ${completion}/man1)
if(LRB_HELP2MAN AND LRB_GZIP)
  set(manual COMMAND sh ${PROJECT_SOURCE_DIR}/tools/manual.sh $<TARGET_FILE:lrbscope> ${completion}/man1
             COMMAND sh -c "exec \"$0\" -9nf \"$1\"/*.1" ${LRB_GZIP} ${completion}/man1)
endif()
add_custom_command(OUTPUT ${completion}/made
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${completion}
  ${manual}
  COMMAND lrbscope --quiet completion bash -o ${completion}/bash/lrbscope
  COMMAND lrbscope --quiet completion zsh -o ${completion}/zsh/_lrbscope
  COMMAND lrbscope --quiet completion fish -o ${completion}/fish/lrbscope.fish
  COMMAND ${CMAKE_COMMAND} -E touch ${completion}/made
  DEPENDS lrbscope ${PROJECT_SOURCE_DIR}/tools/manual.sh ${PROJECT_SOURCE_DIR}/tools/manual.h2m
  COMMENT "Writing manual pages and completions" VERBATIM)
add_custom_target(lrb_completion_files ALL DEPENDS ${completion}/made)

install(DIRECTORY ${completion}/man1/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${completion}/bash/lrbscope DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
install(FILES ${completion}/zsh/_lrbscope DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
install(FILES ${completion}/fish/lrbscope.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
