"""What all figures share: style, axes, labels, the axis along a route."""
