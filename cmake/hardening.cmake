# Flags that make memory errors harder to exploit, for optimised builds without sanitizers.

option(FLEETPLAN_HARDEN "Build with stack protector, checked libc functions, full RELRO and PIE" ON)

if(FLEETPLAN_HARDEN AND NOT FLEETPLAN_SANITIZE)
  set(optimised $<CONFIG:Release,RelWithDebInfo,MinSizeRel>)  # _FORTIFY_SOURCE needs it
  add_compile_options(-fstack-protector-strong -fPIE
                      $<${optimised}:-U_FORTIFY_SOURCE> $<${optimised}:-D_FORTIFY_SOURCE=2>)
  add_link_options(-pie LINKER:-z,relro LINKER:-z,now LINKER:-z,noexecstack)
endif()
