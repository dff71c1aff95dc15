"""Behaviour trees: Nav2's and BehaviorTree.CPP's nodes on py_trees, read from XML."""
