/** Registers all panels: one line each. A large panel imports its body in `create`. */

import "./run";
import "./topics";
import "./image";
import "./raw";
import "./plot";
import "./parameters";
import "./log";
import "./graph";
import "./behavior_tree";
import "./diagnostics";
import "./report";
import "./frames";
import "./nodes";
