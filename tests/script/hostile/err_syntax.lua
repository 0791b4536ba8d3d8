-- Asserts that invalid code compiles.
-- expect: 3: unexpected symbol near
sim:on_step(function() assert(load("x = = 1")) end)
