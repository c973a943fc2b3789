//! Blend, depth and stencil states of the passes.

/// Depth and stencil of the stencil technique.
pub(crate) const STENCIL_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32FloatStencil8;

/// A copy of depths without a stencil.
pub(crate) const COPY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The format of a copy of the host's depths.
pub(crate) fn copy_format(stencil: bool) -> wgpu::TextureFormat {
    if stencil { STENCIL_FORMAT } else { COPY_FORMAT }
}

/// The stencil reference while volumes are painted: the count inside one volume. Counts are compared
/// as reference `compare` count; −1 wraps to 255.
pub(crate) const ONE_COUNTED: u32 = 1;

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
        read_mask: 0xff,
        write_mask: 0xff,
    }
}

/// Paints where the stencil compares with [`ONE_COUNTED`], and clears it there.
pub(crate) fn painting(compare: wgpu::CompareFunction) -> wgpu::DepthStencilState {
    let face = wgpu::StencilFaceState {
        compare,
        fail_op: wgpu::StencilOperation::Keep,
        depth_fail_op: wgpu::StencilOperation::Keep,
        pass_op: wgpu::StencilOperation::Zero,
    };
    let stencil = wgpu::StencilState {
        front: face,
        back: face,
        read_mask: 0xff,
        write_mask: 0xff,
    };
    depth_stencil(STENCIL_FORMAT, wgpu::CompareFunction::Always, stencil)
}
