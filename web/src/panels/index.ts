/** Registers all panels: one line each. A large panel imports its body in `create`. */
