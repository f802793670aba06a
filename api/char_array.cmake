# char_array(NAME HEX OUT): the definition of a char array in C++, from bytes as file(READ ... HEX) or string(HEX)
# gives them; string literals would be limited to 64 KiB by some compilers.
function(char_array name hex out)
  string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${hex}")
  string(REPLACE "'\\x0a'," "'\\x0a',\n" bytes "${bytes}")
  set(${out} "constexpr char ${name}[] = {\n${bytes}};\n" PARENT_SCOPE)
endfunction()
