# Manual pages and the completions of shells, which the program writes from its own definitions.
set(words ${PROJECT_BINARY_DIR}/words)
find_program(LRB_GZIP gzip DOC "gzip, for the manual pages")
set(compress "")
if(LRB_GZIP)
  set(compress COMMAND sh -c "exec \"$0\" -9nf \"$1\"/*.1" "${LRB_GZIP}" "${words}/man1")
endif()
add_custom_command(OUTPUT ${words}/made
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${words}
  COMMAND lrbscope --quiet manual -o ${words}/man1
  ${compress}
  COMMAND lrbscope --quiet completion bash -o ${words}/bash/lrbscope
  COMMAND lrbscope --quiet completion zsh -o ${words}/zsh/_lrbscope
  COMMAND lrbscope --quiet completion fish -o ${words}/fish/lrbscope.fish
  COMMAND ${CMAKE_COMMAND} -E touch ${words}/made
  DEPENDS lrbscope
  COMMENT "Writing manual pages and completions" VERBATIM)
add_custom_target(lrb_words_files ALL DEPENDS ${words}/made)

install(DIRECTORY ${words}/man1/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${words}/bash/lrbscope DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
install(FILES ${words}/zsh/_lrbscope DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
install(FILES ${words}/fish/lrbscope.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
