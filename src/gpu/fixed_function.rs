//! Blend, depth and stencil states of the passes.

/// Depth and stencil of the stencil technique.
pub(crate) const STENCIL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32FloatStencil8;

/// A copy of depths without a stencil.
pub(crate) const COPY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The format of a copy of the host's depths.
pub(crate) fn copy_format(stencil: bool) -> wgpu::TextureFormat {
    if stencil { STENCIL_FORMAT } else { COPY_FORMAT }
}

/// The bits of the stencil that count; −1 wraps to all of them.
const COUNT: u32 = 0x7f;
/// The bit of pixels that a volume of the layer has rejected.
const REJECTED: u32 = 0x80;

/// The stencil reference while volumes are painted: the count inside one volume.
pub(crate) const ONE_COUNTED: u32 = 1;
/// The one while other counts are rejected.
pub(crate) const NONE_COUNTED: u32 = REJECTED;

/// Sums.
pub(crate) const ADD: wgpu::BlendState = {
    let component = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    wgpu::BlendState {
        color: component,
        alpha: component,
    }
};

pub(crate) fn depth_stencil(
    format: wgpu::TextureFormat,
    compare: wgpu::CompareFunction,
    stencil: wgpu::StencilState,
) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format,
        depth_write_enabled: Some(false),
        depth_compare: Some(compare),
        stencil,
        bias: wgpu::DepthBiasState::default(),
    }
}

/// Behind the surface, faces seen from inside the volume count up and those seen from outside down
/// (z-fail). What is flipped is the operations: `front_face` stays the same in all pipelines.
pub(crate) fn counting_stencil(flipped: bool) -> wgpu::StencilState {
    let face = |inside| wgpu::StencilFaceState {
        compare: wgpu::CompareFunction::Always,
        fail_op: wgpu::StencilOperation::Keep,
        depth_fail_op: wgpu::StencilOperation::Keep,
        pass_op: if inside {
            wgpu::StencilOperation::IncrementWrap
        } else {
            wgpu::StencilOperation::DecrementWrap
        },
    };
    wgpu::StencilState {
        front: face(flipped),
        back: face(!flipped),
        read_mask: COUNT,
        write_mask: COUNT,
    }
}

/// Paints where the stencil, compared with [`ONE_COUNTED`], has counted one, and clears the count there. Not
/// where a volume of the layer was rejected: with what is counted once beside one that is counted −1 times,
/// it does not matter which is painted first.
pub(crate) fn painting() -> wgpu::DepthStencilState {
    at_counts(
        wgpu::CompareFunction::Equal,
        COUNT | REJECTED,
        wgpu::StencilOperation::Zero,
    )
}

/// Paints where the stencil, compared with [`NONE_COUNTED`], has counted anything, and clears the count there.
/// If `for_all`, no volume of the layer is painted there any more.
pub(crate) fn rejecting(for_all: bool) -> wgpu::DepthStencilState {
    let operation = if for_all {
        wgpu::StencilOperation::Replace
    } else {
        wgpu::StencilOperation::Zero
    };
    at_counts(wgpu::CompareFunction::NotEqual, COUNT, operation)
}

fn at_counts(
    compare: wgpu::CompareFunction,
    read_mask: u32,
    pass_op: wgpu::StencilOperation,
) -> wgpu::DepthStencilState {
    let face = wgpu::StencilFaceState {
        compare,
        fail_op: wgpu::StencilOperation::Keep,
        depth_fail_op: wgpu::StencilOperation::Keep,
        pass_op,
    };
    let stencil = wgpu::StencilState {
        front: face,
        back: face,
        read_mask,
        write_mask: COUNT | REJECTED,
    };
    depth_stencil(STENCIL_FORMAT, wgpu::CompareFunction::Always, stencil)
}
