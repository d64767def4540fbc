"""A model's operators as the layers that src/stages has: constants, borders and what is not needed are folded away."""
import numpy as np

import tflite as tf

SAME = 0
RELU6 = 3


class Layer:
    """kind: one of the stages' names; a, b: tensors it reads; y: the one it writes; w: float weights, outputs first; bias: float."""

    def __init__(self, kind, a, y, **more):
        self.kind, self.a, self.y, self.b = kind, a, y, None
        self.w = self.bias = None
        self.window, self.stride, self.top, self.left, self.relu6 = 0, 1, 0, 0, False
        self.__dict__.update(more)


class Network:
    """shapes: tensor -> (height, width, channels); outputs: name -> tensor. input_scale: a pixel of 1 is so much of the model's input."""

    def __init__(self, model, outputs):
        self.shapes, self.layers, self.input = {}, [], model.inputs[0]
        self.shapes[self.input] = tuple(model.shapes[self.input][1:])
        self.same = {}  # tensors that are others under a new name
        self.pads = {}  # tensor -> (source, top, left)
        for operator in model.operators:
            self.take(model, operator)
        self.outputs = {name: self.find(tensor) for name, tensor in outputs(model).items()}
        needed, kept = set(self.outputs.values()), []
        for layer in reversed(self.layers):
            if layer.y in needed:
                kept.append(layer)
                needed |= {layer.a} | ({layer.b} if layer.b is not None else set())
        self.layers = kept[::-1]

    def find(self, tensor):
        while tensor in self.same:
            tensor = self.same[tensor]
        return tensor

    def take(self, model, operator):
        code, a, y = operator.code, self.find(operator.inputs[0]), operator.outputs[0]
        shape = model.shapes[y]
        self.shapes[y] = tuple(shape[1:]) if len(shape) == 4 else (1, 1, shape[-1])
        constant = lambda i: model.constants[operator.inputs[i]].astype(np.float32)
        if code == tf.PAD:
            before = model.constants[operator.inputs[1]]
            self.pads[y] = (a, int(before[1][0]), int(before[2][0]))
            if before[3].any():  # channels: an addition takes those that are there
                self.same[y] = a
        elif code in (tf.RESHAPE, tf.LOGISTIC):
            self.same[y] = a
        elif code == tf.CONCATENATION:
            pass  # its parts are outputs of their own
        elif code in (tf.CONV_2D, tf.DEPTHWISE, tf.FULLY_CONNECTED):
            self.take_convolution(operator, code, a, y, constant(1), constant(2))
        elif code == tf.ADD:
            self.layers.append(Layer("add16", a, y, b=self.find(operator.inputs[1]), relu6=operator.option(0) == RELU6))
            if self.shapes[a][2] < self.shapes[self.layers[-1].b][2]:
                self.layers[-1].a, self.layers[-1].b = self.layers[-1].b, a
        elif code == tf.RESIZE_BILINEAR:
            if operator.option(2) or not operator.option(3) or self.shapes[y][0] != 2 * self.shapes[a][0]:
                raise ValueError("a resize that is not twice, with pixel centres at halves")
            self.layers.append(Layer("resize2x16", a, y))
        elif code == tf.MAX_POOL:
            self.layers.append(Layer("maxpool2x16", a, y))
        elif code == tf.DEPTH_TO_SPACE:
            self.layers.append(Layer("depth_to_space16", a, y))
        elif code == tf.MEAN:
            self.layers.append(Layer("sum_pixels16", a, y))
        else:
            raise ValueError(f"operator {code} is none of these models'")

    def take_convolution(self, operator, code, a, y, w, bias):
        relu6 = operator.option({tf.CONV_2D: 3, tf.DEPTHWISE: 4, tf.FULLY_CONNECTED: 0}[code]) == RELU6
        if code == tf.FULLY_CONNECTED or w.shape[1:3] == (1, 1) and code == tf.CONV_2D:
            self.layers.append(Layer("matmul16", a, y, w=w.reshape(w.shape[0], -1), bias=bias, relu6=relu6))
            return
        window, stride = w.shape[1], operator.option(1, "i")
        if code == tf.CONV_2D and window == 2:  # of 2x2 pixels: fully connected
            self.layers.append(Layer("matmul16", a, y, w=w.reshape(w.shape[0], -1), bias=bias, relu6=relu6))
            return
        top = left = 0
        if a in self.pads:
            a, top, left = self.pads[a]
        elif operator.option(0) == SAME:
            height = self.shapes[a][0]
            top = left = max((-(-height // stride) - 1) * stride + window - height, 0) // 2
        kind = "depthwise16" if code == tf.DEPTHWISE else "conv_first16"
        w = w[0] if code == tf.DEPTHWISE else w
        self.layers.append(Layer(kind, a, y, w=w, bias=bias, relu6=relu6, window=window, stride=stride, top=top, left=left))
