# The list of shader modules. One line a module or variant.
