# strut_room(NAME [SUBFOLDERS a b ...] [EXCLUDE file ...] [LINK lib ...] [INSIDE lib ...] [HEADERS lib ...])
#
# Makes strut::NAME, the library of one room: the .cc files of this folder and of its SUBFOLDERS.
# A room without sources is its headers and what it links.
#
# LINK: what its headers need. INSIDE: what only its sources need; who uses the installed room links
# it without seeing it. HEADERS: the same of libraries that are headers alone; who uses the installed
# room does without.
function(strut_room name)
  cmake_parse_arguments(PARSE_ARGV 1 room "" "" "SUBFOLDERS;EXCLUDE;LINK;INSIDE;HEADERS")
  set(patterns ${room_SUBFOLDERS})
  list(TRANSFORM patterns APPEND /*.cc)
  list(APPEND patterns *.cc)
  list(TRANSFORM patterns PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  list(TRANSFORM room_EXCLUDE PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  list(REMOVE_ITEM sources ${room_EXCLUDE})

  if(sources)
    set(scope PUBLIC)
    add_library(strut_${name} STATIC ${sources})
  else()
    set(scope INTERFACE)
    add_library(strut_${name} INTERFACE)
  endif()
  # Warnings and sanitizers are ours; of strut::options an installed room keeps what its headers ask
  # for (install.cmake).
  target_link_libraries(strut_${name} ${scope} $<BUILD_INTERFACE:strut::options> ${room_LINK})
  foreach(library IN LISTS room_INSIDE)
    target_link_libraries(strut_${name} ${scope}
      $<BUILD_INTERFACE:${library}> $<INSTALL_INTERFACE:$<LINK_ONLY:${library}>>)
  endforeach()
  foreach(library IN LISTS room_HEADERS)
    target_link_libraries(strut_${name} ${scope} $<BUILD_INTERFACE:${library}>)
  endforeach()
  add_library(strut::${name} ALIAS strut_${name})
endfunction()
