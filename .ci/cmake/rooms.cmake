# strut_room(NAME [SUBFOLDERS a b ...] [EXCLUDE file ...] [LINK lib ...] [INSIDE lib ...] [HEADERS lib ...])
#
# Makes strut::NAME, the library of one room: the .cc files of this folder and of its SUBFOLDERS.
# A room without sources consists of its headers and its linked libraries.
#
# LINK: libraries that its headers need. INSIDE: libraries that only its sources need; users of the
# installed room link them without their headers. HEADERS: header-only libraries that only its sources
# need; users of the installed room do not need them.
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
  # Warnings and sanitizers apply to our build only; an installed room keeps those of strut::options that
  # its headers need (install.cmake).
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
