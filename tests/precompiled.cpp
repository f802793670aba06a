// Nothing but the precompiled headers, which the tests share.
