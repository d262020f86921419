# The list of shader modules. One line a module or variant.
limn_shader(bench/trace_rays.comp NAME trace_closest)
limn_shader(bench/trace_rays.comp NAME trace_any DEFINES BENCH_ANY=1)
limn_shader(bench/trace_rays.comp NAME trace_closest_alpha DEFINES LIMN_ALPHA=1)
limn_shader(bench/trace_rays.comp NAME trace_any_alpha DEFINES LIMN_ALPHA=1 BENCH_ANY=1)
