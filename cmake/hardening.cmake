# Flags that make memory errors harder to exploit, for optimised builds without sanitizers.

option(FLEETPLAN_HARDEN "Build with stack protector, checked libc functions, full RELRO and PIE" ON)

if(FLEETPLAN_HARDEN AND NOT FLEETPLAN_SANITIZE)
  set(optimised $<CONFIG:Release,RelWithDebInfo,MinSizeRel>)  # _FORTIFY_SOURCE needs it
  # -fPIC instead of -fPIE: the library may become part of a shared library, and its objects are the server's, too. No
  # function is replaced at run time, so nothing is lost by it.
  add_compile_options(-fstack-protector-strong -fPIC -fno-semantic-interposition
                      $<${optimised}:-U_FORTIFY_SOURCE> $<${optimised}:-D_FORTIFY_SOURCE=2>)
  add_link_options(-pie LINKER:-z,relro LINKER:-z,now LINKER:-z,noexecstack)
endif()
