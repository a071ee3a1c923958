# strut_room(NAME [SUBFOLDERS a b ...] [EXCLUDE file ...] [LINK lib ...])
#
# Makes strut::NAME, the library of one room: the .cc files of this folder and of its SUBFOLDERS.
# A room without sources is its headers and what it links.
function(strut_room name)
  cmake_parse_arguments(PARSE_ARGV 1 room "" "" "SUBFOLDERS;EXCLUDE;LINK")
  set(patterns ${room_SUBFOLDERS})
  list(TRANSFORM patterns APPEND /*.cc)
  list(APPEND patterns *.cc)
  list(TRANSFORM patterns PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  list(TRANSFORM room_EXCLUDE PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  list(REMOVE_ITEM sources ${room_EXCLUDE})

  if(sources)
    add_library(strut_${name} STATIC ${sources})
    target_link_libraries(strut_${name} PUBLIC strut::options ${room_LINK})
  else()
    add_library(strut_${name} INTERFACE)
    target_link_libraries(strut_${name} INTERFACE strut::options ${room_LINK})
  endif()
  add_library(strut::${name} ALIAS strut_${name})
endfunction()
