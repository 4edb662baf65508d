# SPDX-License-Identifier: Apache-2.0
# The programs and what they need beside them: found relative to the program, never through the
# build tree.

# boresight_documents_of(PROGRAM): its manual pages, which help2man writes from what --help prints, and
# its completions. Without help2man there are no manual pages.
find_program(BORESIGHT_HELP2MAN help2man)
mark_as_advanced(BORESIGHT_HELP2MAN)
function(boresight_documents_of program)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${program}_documents)
  if(BORESIGHT_HELP2MAN)
    add_custom_command(OUTPUT ${folder}/man1/${program}.1
      COMMAND ${CMAKE_COMMAND} -E rm -rf ${folder}/man1
      # Leaks of the libraries are looked for by tests, not by a build under a sanitizer.
      COMMAND ${CMAKE_COMMAND} -E env ASAN_OPTIONS=detect_leaks=0
        ${CMAKE_CURRENT_SOURCE_DIR}/manual_pages.sh ${folder}/man1 $<TARGET_FILE:${program}>
      DEPENDS ${program} manual_pages.sh VERBATIM
      COMMENT "Writing manual pages of ${program}")
    add_custom_target(${program}_pages ALL DEPENDS ${folder}/man1/${program}.1)
    install(DIRECTORY ${folder}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT programs)
  endif()
  set(completions ${CMAKE_CURRENT_SOURCE_DIR}/completions)
  install(FILES ${completions}/${program}
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT programs)
  install(FILES ${completions}/_${program}
    DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT programs)
  install(FILES ${completions}/${program}.fish
    DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT programs)
endfunction()

install(TARGETS whs RUNTIME COMPONENT programs)
boresight_documents_of(whs)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/sessions/examples ${PROJECT_SOURCE_DIR}/resources/matchers
  DESTINATION ${CMAKE_INSTALL_DATADIR}/boresight COMPONENT programs
  PATTERN "*.boresight.*" EXCLUDE PATTERN node_modules EXCLUDE)
install(FILES
  ${PROJECT_SOURCE_DIR}/sessions/examples/annotated.boresight.json
  ${PROJECT_SOURCE_DIR}/sessions/examples/example.boresight.json
  ${PROJECT_SOURCE_DIR}/sessions/examples/turned.boresight.json
  DESTINATION ${CMAKE_INSTALL_DATADIR}/boresight/examples COMPONENT programs)
install(FILES ${PROJECT_SOURCE_DIR}/README.md
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/boresight COMPONENT programs)
boresight_debian_documents(boresight programs)

if(BORESIGHT_BUILD_UI)
  set(desktop ${PROJECT_SOURCE_DIR}/resources/desktop)
  install(TARGETS boresight RUNTIME COMPONENT programs)
  boresight_documents_of(boresight)
  install(FILES ${desktop}/boresight.desktop
    DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT programs)
  install(FILES ${desktop}/boresight-mime.xml
    DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages RENAME boresight.xml COMPONENT programs)
  install(FILES ${desktop}/boresight.svg
    DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT programs)
endif()

# The manual: pages of the source and pages that the programs write, in one folder. In the build tree
# it lies where the program looks for an installed one.
set(manual ${PROJECT_BINARY_DIR}/share/boresight/manual)
set(written ${CMAKE_CURRENT_BINARY_DIR}/manual)
file(GLOB_RECURSE manual_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/core/*.md
  ${PROJECT_SOURCE_DIR}/resources/*.md ${PROJECT_SOURCE_DIR}/resources/manual/pictures/*.png
  ${PROJECT_SOURCE_DIR}/sessions/*.md)
set(pages ${written}/options.md ${written}/whs.md)
set(no_leaks ${CMAKE_COMMAND} -E env ASAN_OPTIONS=detect_leaks=0)
add_custom_command(OUTPUT ${written}/options.md ${written}/whs.md
  COMMAND ${no_leaks} $<TARGET_FILE:whs> documents ${written}
  DEPENDS whs VERBATIM
  COMMENT "Writing pages of the manual")
if(BORESIGHT_BUILD_UI)
  list(APPEND pages ${written}/boresight.md ${written}/keys.md)
  add_custom_command(OUTPUT ${written}/boresight.md ${written}/keys.md
    COMMAND ${no_leaks} $<TARGET_FILE:boresight> --documents ${written}
    DEPENDS boresight VERBATIM
    COMMENT "Writing pages of the manual")
endif()
add_custom_command(OUTPUT ${manual}/index.md
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DWRITTEN=${written} -DFOLDER=${manual}
    -P ${CMAKE_CURRENT_SOURCE_DIR}/manual.cmake
  DEPENDS ${manual_sources} ${pages} manual.cmake VERBATIM
  COMMENT "Putting the manual together")
add_custom_target(manual ALL DEPENDS ${manual}/index.md)
install(DIRECTORY ${manual} DESTINATION ${CMAKE_INSTALL_DATADIR}/boresight COMPONENT programs)
